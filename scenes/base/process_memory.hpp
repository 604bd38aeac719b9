#pragma once
// How much memory this process uses, and how much more it may use.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

namespace beambench {

/// Bytes that this process may still use: what is left of BEAMBENCH_MEMORY where that is set, a
/// number of bytes with an optional unit of 1024 (`800M`, `12G`); else the least of what the system
/// has available without swapping and what is left of the limits of the process's control group
/// and the groups above it. `root` is the folder that holds /proc and the mounts. Nothing where the
/// system says none of them. Throws InputError for another text in BEAMBENCH_MEMORY.
std::optional<std::uint64_t> available_memory(const std::filesystem::path& root = "/");

/// Bytes of memory of its own that this process has mapped, used or not: what RLIMIT_DATA limits.
/// Nothing where the system does not say.
std::optional<std::uint64_t> mapped_data_bytes();

/// Runs `work`, and returns by how many bytes the resident memory of this process was at most
/// larger meanwhile than before, what other threads use included. Nothing where the system does not
/// say (before Linux 4.0, or without /proc). Passes on what `work` throws.
std::optional<std::uint64_t> peak_memory_growth(const std::function<void()>& work);

}  // namespace beambench

#pragma once
// How much memory this process uses, and how much more it may use.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

namespace beambench {

/// Returns how many bytes this process may still use: the rest of BEAMBENCH_MEMORY if that is set,
/// a number of bytes with an optional binary unit (`800M`, `12G`). Otherwise, the minimum of the
/// memory that the system has available without swapping and the memory left under the limits of
/// the process's control group and the groups above it. `root` is the folder that holds /proc and
/// the mounts. Returns nothing if none of these is known. Throws InputError for any other text in
/// BEAMBENCH_MEMORY.
std::optional<std::uint64_t> available_memory(const std::filesystem::path& root = "/");

/// Returns the bytes of private memory that this process has mapped, used or not: the quantity that
/// RLIMIT_DATA limits. Nothing if unknown.
std::optional<std::uint64_t> mapped_data_bytes();

/// Runs `work` and returns the growth of this process's peak resident memory above its level before
/// the call, including what other threads used. Nothing if unknown (before Linux 4.0, or without
/// /proc). Propagates exceptions of `work`.
std::optional<std::uint64_t> peak_memory_growth(const std::function<void()>& work);

}  // namespace beambench

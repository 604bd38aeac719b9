#pragma once
// How much memory this process uses, and how much more it may use.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

namespace beambench {

/// Returns how many bytes this process may still use. If BEAMBENCH_MEMORY is set to a number of
/// bytes with an optional binary unit (`800M`, `12G`), this is what the process has left of it.
/// Otherwise, it is the minimum of the memory that the system has available without swapping and
/// the memory left under the limits of the process's control group and the groups above it. Returns
/// nothing if none of these is known. `root` is the folder that holds /proc and the mounts. Throws
/// InputError for any other text in BEAMBENCH_MEMORY.
std::optional<std::uint64_t> available_memory(const std::filesystem::path& root = "/");

/// Returns the bytes of private memory that this process has mapped, used or not: the quantity that
/// RLIMIT_DATA limits. Returns nothing if unknown.
std::optional<std::uint64_t> mapped_data_bytes();

/// Runs `work` and returns the growth of this process's peak resident memory above its level before
/// the call, including what other threads used. Returns nothing if unknown (before Linux 4.0, or
/// without /proc). Exceptions of `work` are propagated.
std::optional<std::uint64_t> peak_memory_growth(const std::function<void()>& work);

}  // namespace beambench

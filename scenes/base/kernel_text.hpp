#pragma once
// Reads texts that the kernel writes in /proc and /sys.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace beambench {

/// Returns the text of a kernel file, or an empty string if the file does not exist.
std::string kernel_text(const std::filesystem::path& path);

/// Returns the whole number at the start of a text, after blanks, or nothing for `max` and `-1`.
std::optional<std::uint64_t> number_at(std::string_view text);

/// Returns the number after a key at the beginning of a line: `MemAvailable: 123 kB` for
/// "MemAvailable:", `nr_periods 14` for "nr_periods ".
std::optional<std::uint64_t> value_of(std::string_view text, std::string_view key);

}  // namespace beambench

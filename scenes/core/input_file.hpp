#pragma once
// The one way in which input is read.

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

namespace beambench {

inline constexpr std::uint64_t kNoByteLimit = std::numeric_limits<std::uint64_t>::max();

/// Reads an input whole: a file, or what comes through a pipe or a device until its end
/// (`/dev/stdin` is the standard input). Nothing is ever returned of an input that did not come
/// whole: throws InputError naming the path and the reason when it cannot be opened, is a folder,
/// holds more than `max_bytes`, does not fit into memory, when the system reports an error while
/// it is read, or when it ends before the length that it had at the beginning.
std::string read_input(const std::filesystem::path& path, std::uint64_t max_bytes = kNoByteLimit);

/// The same of an open descriptor, read from where it stands; `name` stands for it in messages. It
/// stays open.
std::string read_input(int descriptor, const std::string& name,
                       std::uint64_t max_bytes = kNoByteLimit);

}  // namespace beambench

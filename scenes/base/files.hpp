#pragma once
// The one function that opens input, the one that writes output, logs that grow, and locks of
// folders.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace beambench {

/// What people write (a sweep, an entry of the cache, the index of a kit) is at most so long: 64
/// MiB.
inline constexpr std::uint64_t kLargestDocument = std::uint64_t{64} << 20U;
/// And what programs write in one piece: 4 GiB.
inline constexpr std::uint64_t kLargestFile = std::uint64_t{4} << 30U;

/// Reads a whole input: a file, or what comes through a pipe or a device until its end
/// (`/dev/stdin` is the standard input). Opening never waits: a named pipe into which nothing is
/// written is refused. Where a program has the pipe open but does not write, it is waited for, as
/// anywhere in a shell. No part of an input that is incomplete is ever returned: throws InputError
/// naming the path and the reason when it cannot be opened, is a folder, holds more than
/// `max_bytes` (64 MiB of a device, which may have no end), does not fit into memory, when the
/// system reports an error while it is read, or when it ends before the length that it had at the
/// beginning.
std::string read_input(const std::filesystem::path& path, std::uint64_t max_bytes);

/// The same for an open descriptor, read from its current position; `name` stands for it in
/// messages. It stays open.
std::string read_input(int descriptor, const std::string& name, std::uint64_t max_bytes);

/// Reads a text as `read_input` does. A byte order mark of UTF-8 at its beginning, which some
/// editors write, is skipped, and UTF-16 is refused (`plain_text`).
std::string read_text_input(const std::filesystem::path& path, std::uint64_t max_bytes);

/// An input that is read part by part, for what may be larger than memory. Opened, read and refused
/// by the rules of `read_input`; a file that ends early is found when its end is reached.
class InputStream {
 public:
  explicit InputStream(const std::filesystem::path& path);
  ~InputStream();
  InputStream(InputStream&&) noexcept;
  InputStream& operator=(InputStream&&) = delete;

  /// The next line without its end, "\n" or "\r\n"; nothing at the end of the input. A byte order
  /// mark before the first line is skipped. The line stays until the next call. Throws InputError
  /// for a line of more than 256 MiB.
  std::optional<std::string_view> line();
  /// Fills the buffer and returns how many bytes it got: fewer only at the end of the input.
  std::size_t read(std::span<char> buffer);
  /// How many bytes follow; nothing for a pipe or a device.
  std::optional<std::uint64_t> remaining() const;
  /// How many bytes came before: of lines and of `read`.
  std::uint64_t position() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Throws InputError when output cannot go there: the folder is missing or not writable, a folder
/// stands in the file's place, a device is not writable, symbolic links lead nowhere. For refusing
/// a request before the long work starts.
void require_writable(const std::filesystem::path& target);

/// Writes an output. A file is written completely or not at all: beside its place (under a name
/// with its ending), synced to the disk, and renamed onto it; through a symbolic link, the file
/// that it leads to. What is not a regular file (a device, a named pipe, the standard output) is
/// never replaced but written into; a named pipe waits for its reader. Throws InputError when that
/// cannot be done.
void write_file(const std::filesystem::path& target, std::string_view text);
/// The same, for what is too long to be built in memory first: `write` puts it into the stream. If
/// it throws, the file stays as it was.
void write_file(const std::filesystem::path& target,
                const std::function<void(std::ostream&)>& write);

/// A file to which lines are added, such as a log. A line is given to the system at once, in one
/// piece: it is there whatever happens to this process. Nothing waits for the disk.
class GrowingFile {
 public:
  /// Opens or makes the file; what follows its first `bytes` is cut off. Throws InputError when it
  /// cannot be written.
  explicit GrowingFile(const std::filesystem::path& path, std::uint64_t bytes = 0);
  ~GrowingFile();
  GrowingFile(GrowingFile&& other) noexcept;
  GrowingFile& operator=(GrowingFile&&) = delete;

  /// Adds a line and its end. Throws InputError when the disk is full or fails; the file is then as
  /// it was.
  void add_line(std::string_view line);

 private:
  std::filesystem::path path_;
  int descriptor_;
  std::uint64_t bytes_;
};

/// Makes a folder and those above it, unless it is there. Throws InputError, with what to do about
/// it.
void make_folder(const std::filesystem::path& folder,
                 std::string_view remedy = "choose another place");

/// Whether this is the file beside its place that a killed process was writing.
bool is_left_behind(const std::filesystem::path& path);

/// Holds a folder while it lives: one process at a time. The system releases it when the process
/// ends, however it ends.
class FolderLock {
 public:
  /// Throws InputError when another process holds the folder. Where the file system has no locks,
  /// nothing is held.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&&) = delete;
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace beambench

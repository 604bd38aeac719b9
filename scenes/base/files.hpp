#pragma once
// Opens input, writes output, and provides append-only logs and folder locks.

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

/// The size limit of small documents (a sweep, a cache entry, the index of a kit): 64 MiB.
inline constexpr std::uint64_t kLargestDocument = std::uint64_t{64} << 20U;
/// The size limit of files that programs write in one piece: 4 GiB.
inline constexpr std::uint64_t kLargestFile = std::uint64_t{4} << 30U;

/// Reads a whole input: a file, or a pipe or device until its end (`/dev/stdin` is the standard
/// input). Opening never waits: a named pipe without a writer is refused. If a program has the pipe
/// open but does not write, reading waits for it, as in any shell pipeline. Never returns an
/// incomplete input. Throws InputError with the path and the reason if the input cannot be opened,
/// is a folder, holds more than `max_bytes` (64 MiB for a device, which may have no end), does not
/// fit into memory or ends before its initial length, or if the system reports an error while
/// reading.
std::string read_input(const std::filesystem::path& path, std::uint64_t max_bytes);

/// Reads an open descriptor in the same way from its current position, and leaves it open. Messages
/// call it `name`.
std::string read_input(int descriptor, const std::string& name, std::uint64_t max_bytes);

/// Reads text like `read_input`. Skips a UTF-8 byte order mark at the beginning, which some editors
/// write, and refuses UTF-16 (`plain_text`).
std::string read_text_input(const std::filesystem::path& path, std::uint64_t max_bytes);

/// An input read in parts, for inputs that may be larger than memory. The rules of `read_input`
/// apply; a premature end of a file is detected when it is reached.
class InputStream {
 public:
  explicit InputStream(const std::filesystem::path& path);
  ~InputStream();
  InputStream(InputStream&&) noexcept;
  InputStream& operator=(InputStream&&) = delete;

  /// Returns the next line without its end ("\n" or "\r\n"), or nothing at the end of the input. A
  /// byte order mark before the first line is skipped. The line is valid until the next call.
  /// Throws InputError for a line of more than 256 MiB.
  std::optional<std::string_view> line();
  /// Fills the buffer and returns the number of bytes read, which is smaller only at the end of the
  /// input.
  std::size_t read(std::span<char> buffer);
  /// Returns the number of bytes left, or nothing for a pipe or a device.
  std::optional<std::uint64_t> remaining() const;
  /// Returns the number of bytes taken so far by `line` and `read`.
  std::uint64_t position() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Throws InputError if output cannot be written to `target`: its folder is missing or not
/// writable, a folder has the file's name, a device is not writable, or symbolic links are broken.
/// Used to reject a request before long work starts.
void require_writable(const std::filesystem::path& target);

/// Writes output. A file is written completely or not at all: under a temporary name in the same
/// folder (with the same ending), synced to the disk, and renamed. If the path is a symbolic link,
/// its target is replaced. Anything other than a regular file (a device, a named pipe, the standard
/// output) is written to, never replaced; a named pipe waits for its reader. Throws InputError on
/// failure.
void write_file(const std::filesystem::path& target, std::string_view text);
/// Writes output that is too long to be built in memory first: `write` writes it to the stream. If
/// `write` throws, the file is unchanged.
void write_file(const std::filesystem::path& target,
                const std::function<void(std::ostream&)>& write);

/// A file to which lines are added, such as a log. Each line is passed to the system immediately,
/// in one piece, so it survives the end of this process. Writes do not wait for the disk.
class GrowingFile {
 public:
  /// Opens or creates the file and truncates it to its first `bytes`. Throws InputError if it
  /// cannot be written.
  explicit GrowingFile(const std::filesystem::path& path, std::uint64_t bytes = 0);
  ~GrowingFile();
  GrowingFile(GrowingFile&& other) noexcept;
  GrowingFile& operator=(GrowingFile&&) = delete;

  /// Adds a line and a line end. Throws InputError if the disk is full or fails; the file is then
  /// unchanged.
  void add_line(std::string_view line);

 private:
  std::filesystem::path path_;
  int descriptor_;
  std::uint64_t bytes_;
};

/// Creates a folder and its parents if necessary. Throws InputError with `remedy` on failure.
void make_folder(const std::filesystem::path& folder,
                 std::string_view remedy = "choose another place");

/// Returns whether the path is a temporary file left by a killed process.
bool is_left_behind(const std::filesystem::path& path);

/// Locks a folder during its lifetime, for one process at a time. The system releases the lock when
/// the process ends, however it ends.
class FolderLock {
 public:
  /// Throws InputError if another process holds the lock. On a file system without locks, nothing
  /// is locked.
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

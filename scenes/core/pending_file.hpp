#pragma once
// Output: files are whole or not there, links stay links, devices and pipes stay what they are.

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string_view>

namespace beambench {

/// Throws InputError when output cannot go there: the folder is missing or not writable, a folder
/// stands in the file's place, a device is not writable, symbolic links lead nowhere. For refusing
/// a request before the long work starts.
void require_writable(const std::filesystem::path& target);

/// A file being written beside its target and renamed onto it by `commit`; without a commit it is
/// removed and the target stays as it was. Where the target is a symbolic link, the file that it
/// leads to is the one that is replaced.
class PendingFile {
 public:
  /// Creates the file, empty. Throws InputError when that cannot be done.
  explicit PendingFile(const std::filesystem::path& target);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  /// Where to write meanwhile: a name of its own in the target's folder, with its ending.
  const std::filesystem::path& path() const { return path_; }
  /// Brings what was written to the disk and renames it; a power loss later does not undo it.
  /// Throws InputError when that fails.
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path path_;
  bool committed_ = false;
};

/// Is this the file that a PendingFile was writing when its process was killed?
bool is_left_behind(const std::filesystem::path& path);

/// The one way to write output. A file is written whole or not at all: beside its place, and
/// renamed onto it; of a symbolic link, the file that it leads to. What is no regular file (a
/// device, a named pipe, the standard output) is never replaced but written into; a named pipe
/// waits for its reader. Throws InputError when that cannot be done.
void write_file(const std::filesystem::path& target, std::string_view text);
/// The same, for what is too long to be put together first: `write` puts it into the stream.
void write_file(const std::filesystem::path& target,
                const std::function<void(std::ostream&)>& write);

}  // namespace beambench

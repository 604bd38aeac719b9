#pragma once
// Files that are either whole or not there.

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string_view>

namespace beambench {

/// Throws InputError when a file of that name cannot be made: its folder is missing or not
/// writable, or a folder stands in its place. For refusing a request before the long work starts.
void require_writable(const std::filesystem::path& target);

/// A file being written beside its target and renamed onto it by `commit`; without a commit it is
/// removed and the target stays as it was.
class PendingFile {
 public:
  /// Creates the file, empty. Throws InputError when that cannot be done.
  explicit PendingFile(std::filesystem::path target);
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

/// Writes a text file whole or not at all. Throws InputError when it cannot be written.
void write_file(const std::filesystem::path& target, std::string_view text);
/// The same, for what is too long to be put together first: `write` puts it into the stream.
void write_file(const std::filesystem::path& target,
                const std::function<void(std::ostream&)>& write);

}  // namespace beambench

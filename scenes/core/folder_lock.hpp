#pragma once
// One process at a time in a folder.

#include <filesystem>

namespace beambench {

/// Holds a folder while it lives. The system lets go of it when the process ends, however it ends.
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

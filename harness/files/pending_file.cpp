#include "harness/files/pending_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "scenes/error.hpp"

namespace beambench {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& target, std::string_view why, std::string_view remedy) {
  throw InputError(fmt::format("cannot write '{}': {}; {}", target.string(), why, remedy));
}

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

/// Waits until the file's contents are on the disk; false when they cannot be brought there.
bool reaches_disk(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool synced = ::fsync(file) == 0;
  return (::close(file) == 0) && synced;
}

}  // namespace

void require_writable(const fs::path& target) {
  std::error_code ignored;
  const fs::path folder = folder_of(target);
  if (!target.has_filename()) refuse(target, "it names a folder", "add a file name");
  if (fs::is_directory(target, ignored)) refuse(target, "it is a folder", "add a file name");
  if (!fs::exists(folder, ignored)) {
    refuse(target, fmt::format("the folder '{}' does not exist", folder.string()),
           "create it or choose another");
  }
  if (!fs::is_directory(folder, ignored)) {
    refuse(target, fmt::format("'{}' is not a folder", folder.string()), "choose another place");
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    refuse(target, fmt::format("the folder '{}' is not writable", folder.string()),
           "choose another or change its permissions");
  }
}

PendingFile::PendingFile(fs::path target) : target_(std::move(target)) {
  require_writable(target_);
  path_ = folder_of(target_) / fmt::format(".{}.{}.partial{}", target_.stem().string(), ::getpid(),
                                           target_.extension().string());
  const int file = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) refuse(target_, std::strerror(errno), "choose another place");
  ::close(file);
}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!committed_) fs::remove(path_, ignored);
}

void PendingFile::commit() {
  if (!reaches_disk(path_)) {
    refuse(target_, std::strerror(errno), "make room on the disk or choose another place");
  }
  std::error_code error;
  fs::rename(path_, target_, error);
  if (error) refuse(target_, error.message(), "choose another place");
  committed_ = true;
}

void write_file(const fs::path& target, std::string_view text) {
  write_file(target, [text](std::ostream& file) {
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
  });
}

void write_file(const fs::path& target, const std::function<void(std::ostream&)>& write) {
  PendingFile pending(target);
  std::ofstream file(pending.path(), std::ios::binary);
  write(file);
  file.close();
  if (!file) {
    refuse(target, std::strerror(errno), "make room on the disk or choose another place");
  }
  pending.commit();
}

}  // namespace beambench

#include "scenes/core/pending_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "scenes/core/descriptor_buffer.hpp"
#include "scenes/core/error.hpp"
#include "scenes/core/output_target.hpp"

namespace beambench {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPartial = ".partial";  // in the names of files that are being written

[[noreturn]] void refuse(const fs::path& target, std::string_view why, std::string_view remedy) {
  throw InputError(fmt::format("cannot write '{}': {}; {}", target.string(), why, remedy));
}

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

/// What the system says, and what to do about it.
[[noreturn]] void refuse_by_error(const fs::path& target, int error) {
  if (error == ENOSPC || error == EDQUOT) {
    refuse(target, fmt::format("the disk of the folder '{}' is full", folder_of(target).string()),
           "make room there or choose another place");
  }
  refuse(target, error == 0 ? "the writing failed" : std::strerror(error), "choose another place");
}

/// Waits until what a file or folder holds is on the disk; false, with errno set, when it cannot be
/// brought there.
bool reaches_disk(const fs::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  // Some file systems have nothing to sync for a folder and say EINVAL.
  const bool synced = ::fsync(file) == 0 || errno == EINVAL;
  const int error = errno;
  ::close(file);
  errno = error;
  return synced;
}

/// Refuses folders.
OutputTarget target_of(const fs::path& target) {
  if (!target.has_filename()) refuse(target, "it names a folder", "add a file name");
  try {
    OutputTarget found = find_output_target(target);
    if (found.kind != OutputTarget::Kind::kFolder) return found;
  } catch (const fs::filesystem_error& error) {
    refuse(target, error.code().message(), "choose another place");
  }
  refuse(target, "it is a folder", "add a file name");
}

void write_into(int descriptor, const fs::path& target,
                const std::function<void(std::ostream&)>& write) {
  DescriptorBuffer buffer(descriptor);
  std::ostream stream(&buffer);
  write(stream);
  stream.flush();
  if (stream) return;
  refuse(target, buffer.error() == 0 ? "the writing failed" : std::strerror(buffer.error()),
         "choose another place");
}

/// A device or pipe that is open for writing, closed at the end.
class OpenNode {
 public:
  explicit OpenNode(const fs::path& path)
      : descriptor_(::open(path.c_str(), O_WRONLY | O_TRUNC | O_NOCTTY | O_CLOEXEC)) {
    if (descriptor_ < 0) refuse_by_error(path, errno);
  }
  ~OpenNode() { ::close(descriptor_); }
  OpenNode(const OpenNode&) = delete;
  OpenNode& operator=(const OpenNode&) = delete;

  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Writes into what is not replaced. What has gone into it cannot be taken back.
void write_through(const fs::path& target, const OutputTarget& found,
                   const std::function<void(std::ostream&)>& write) {
  if (found.kind == OutputTarget::Kind::kOpen) {
    std::fflush(nullptr);  // what was printed before comes first
    write_into(found.descriptor, target, write);
  } else {
    write_into(OpenNode(target).descriptor(), target, write);
  }
}

}  // namespace

void require_writable(const fs::path& target) {
  const OutputTarget found = target_of(target);
  if (found.kind == OutputTarget::Kind::kOpen) return;
  if (found.kind == OutputTarget::Kind::kNode) {
    if (::access(target.c_str(), W_OK) != 0) refuse_by_error(target, errno);
    return;
  }
  std::error_code ignored;
  const fs::path folder = folder_of(found.path);
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

PendingFile::PendingFile(const fs::path& target) : target_(target_of(target).path) {
  require_writable(target);
  path_ = folder_of(target_) / fmt::format(".{}.{}{}{}", target_.stem().string(), ::getpid(),
                                           kPartial, target_.extension().string());
  const int file = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) refuse_by_error(target_, errno);
  ::close(file);
}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (!committed_) fs::remove(path_, ignored);
}

void PendingFile::commit() {
  if (!reaches_disk(path_)) refuse_by_error(target_, errno);
  std::error_code error;
  fs::rename(path_, target_, error);
  if (error) refuse_by_error(target_, error.value());
  committed_ = true;
  // The new name is the folder's contents: without this a power loss could bring back the old file.
  if (!reaches_disk(folder_of(target_))) refuse_by_error(target_, errno);
}

bool is_left_behind(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with('.') && name.find(kPartial) != std::string::npos;
}

void write_file(const fs::path& target, std::string_view text) {
  write_file(target, [text](std::ostream& file) {
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
  });
}

void write_file(const fs::path& target, const std::function<void(std::ostream&)>& write) {
  const OutputTarget found = target_of(target);
  if (found.kind != OutputTarget::Kind::kFile) {
    write_through(target, found, write);
    return;
  }
  PendingFile pending(target);
  errno = 0;
  std::ofstream file(pending.path(), std::ios::binary);
  write(file);
  file.close();
  if (!file) refuse_by_error(target, errno);
  pending.commit();
}

}  // namespace beambench

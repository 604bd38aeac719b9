#include "scenes/core/output_target.hpp"

#include <cerrno>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

namespace beambench {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxLinks = 40;  // the kernel's own limit

[[noreturn]] void fail(const fs::path& path, int error) {
  throw fs::filesystem_error("cannot be written", path, {error, std::generic_category()});
}

bool is_same(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// The descriptor, standard output or error, that goes where the path leads; -1 when neither does.
/// A file put in its place would be one that the rest of the output does not reach.
int open_descriptor_of(const struct stat& status) {
  for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO}) {
    struct stat open {};
    if (::fstat(descriptor, &open) == 0 && is_same(open, status)) return descriptor;
  }
  return -1;
}

/// Where a link leads whose end is not there yet.
fs::path end_of_dangling(const fs::path& path) {
  fs::path end = path;
  for (int links = 0; fs::is_symlink(fs::symlink_status(end)); ++links) {
    if (links == kMaxLinks) fail(path, ELOOP);
    end = end.parent_path() / fs::read_symlink(end);  // an absolute one replaces the folder
  }
  return end;
}

/// The path of an existing regular file without links; the path itself when the file is open
/// somewhere but has no name any more (`/dev/fd/3` of a deleted file).
OutputTarget file_target(const fs::path& path, const struct stat& status) {
  std::error_code no_name;
  const fs::path real = fs::canonical(path, no_name);
  struct stat found {};
  const bool is_there = !no_name && ::stat(real.c_str(), &found) == 0 && is_same(found, status);
  if (!is_there) return {OutputTarget::Kind::kNode, path};
  return {OutputTarget::Kind::kFile, real};
}

}  // namespace

OutputTarget find_output_target(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    if (errno != ENOENT && errno != ENOTDIR) fail(path, errno);
    return {OutputTarget::Kind::kFile, end_of_dangling(path)};
  }
  if (S_ISDIR(status.st_mode)) return {OutputTarget::Kind::kFolder, path};
  if (const int open = open_descriptor_of(status); open >= 0) {
    return {OutputTarget::Kind::kOpen, path, open};
  }
  if (!S_ISREG(status.st_mode)) return {OutputTarget::Kind::kNode, path};
  return file_target(path, status);
}

}  // namespace beambench

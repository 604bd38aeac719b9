#include "scenes/core/input_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "scenes/core/error.hpp"

namespace beambench {
namespace {

constexpr std::size_t kFirstBlock = std::size_t{1} << 16U;   // of what has no length of its own
constexpr std::size_t kLargestRead = std::size_t{1} << 30U;  // one call reads no more than 2 GiB

[[noreturn]] void refuse(const std::string& name, std::string_view why, std::string_view remedy) {
  throw InputError(fmt::format("{}: cannot be read: {}; {}", name, why, remedy));
}

[[noreturn]] void refuse_by_error(const std::string& name, int error) {
  const bool path_is_wrong = error == ENOENT || error == EACCES || error == ENOTDIR;
  refuse(name, std::strerror(error),
         path_is_wrong ? "check the path and its permissions" : "try a copy on another disk");
}

[[noreturn]] void refuse_size(const std::string& name, std::uint64_t max_bytes) {
  refuse(name, fmt::format("it holds more than {} bytes", max_bytes), "divide it or reduce it");
}

/// A descriptor, closed at the end.
class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) refuse_by_error(path.string(), errno);
  }
  ~OpenFile() { ::close(descriptor_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// How many bytes are left of a regular file; 0 of whatever has no length (a pipe, a file of
/// /proc).
std::uint64_t known_length(int descriptor, const std::string& name) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) refuse_by_error(name, errno);
  if (S_ISDIR(status.st_mode)) refuse(name, "it is a folder", "name a file in it");
  if (!S_ISREG(status.st_mode)) return 0;
  const off_t position = ::lseek(descriptor, 0, SEEK_CUR);
  return static_cast<std::uint64_t>(
      std::max<off_t>(status.st_size - std::max<off_t>(position, 0), 0));
}

std::string read_whole(int descriptor, const std::string& name, std::uint64_t max_bytes) {
  const std::uint64_t length = known_length(descriptor, name);
  if (length > max_bytes) refuse_size(name, max_bytes);
  // One byte more than is known of: the end is seen without growing.
  std::string bytes(length > 0 ? length + 1 : kFirstBlock, '\0');
  std::size_t used = 0;
  for (;;) {
    if (used == bytes.size()) bytes.resize(2 * bytes.size());
    const ssize_t count =
        ::read(descriptor, bytes.data() + used, std::min(bytes.size() - used, kLargestRead));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse_by_error(name, errno);
    if (count == 0) break;
    used += static_cast<std::size_t>(count);
    if (used > max_bytes) refuse_size(name, max_bytes);
  }
  if (used < length) {
    refuse(name, fmt::format("it ended after {} of its {} bytes", used, length),
           "wait until it is no longer being written");
  }
  bytes.resize(used);
  return bytes;
}

}  // namespace

std::string read_input(int descriptor, const std::string& name, std::uint64_t max_bytes) {
  try {
    return read_whole(descriptor, name, max_bytes);
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {  // more than a string can hold
  }
  refuse(name, "out of memory", "close other programs, or divide the file");
}

std::string read_input(const std::filesystem::path& path, std::uint64_t max_bytes) {
  const OpenFile file(path);
  return read_input(file.descriptor(), path.string(), max_bytes);
}

}  // namespace beambench

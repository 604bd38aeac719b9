#include "scenes/meshes/mesh_bytes.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <zlib.h>

#include "scenes/error.hpp"

namespace beambench {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, std::string_view why) {
  throw InputError(fmt::format("{}: {}", path.string(), why));
}

[[noreturn]] void refuse_size(const std::filesystem::path& path) {
  refuse(path, "it holds more than 4 GiB; split it, or reduce its triangles");
}

/// zlib's state of reading one gzip file.
class Inflation {
 public:
  explicit Inflation(std::string_view packed) : packed_(packed) {
    usable_ = inflateInit2(&stream_, 16 + MAX_WBITS) == Z_OK;  // 16: gzip's header and checksum
  }
  ~Inflation() {
    if (usable_) inflateEnd(&stream_);
  }
  Inflation(const Inflation&) = delete;
  Inflation& operator=(const Inflation&) = delete;

  /// Fills the buffer as far as possible; how many bytes came.
  std::size_t fill(char* buffer, std::size_t size) {
    stream_.next_out = reinterpret_cast<Bytef*>(buffer);
    stream_.avail_out = limited(size);
    const std::size_t wanted = stream_.avail_out;
    while (usable_ && !done_ && stream_.avail_out > 0) step();
    return wanted - stream_.avail_out;
  }
  bool done() const { return done_; }
  bool damaged() const { return !usable_; }

 private:
  static uInt limited(std::size_t size) {
    return static_cast<uInt>(std::min<std::size_t>(size, std::numeric_limits<uInt>::max()));
  }

  void step() {
    const auto* next = reinterpret_cast<const Bytef*>(packed_.data());
    stream_.next_in = const_cast<Bytef*>(next);  // zlib only reads it
    stream_.avail_in = limited(packed_.size());
    const uInt before = stream_.avail_in;
    const int result = inflate(&stream_, Z_NO_FLUSH);
    packed_.remove_prefix(before - stream_.avail_in);
    if (result == Z_STREAM_END) {
      done_ = packed_.empty();
      if (!done_ && inflateReset(&stream_) != Z_OK) fail();  // gzip files may be put in a row
    } else if (result != Z_OK) {
      fail();  // Z_BUF_ERROR among them: the file ends too early
    }
  }
  void fail() {
    inflateEnd(&stream_);
    usable_ = false;
  }

  std::string_view packed_;
  z_stream stream_{};
  bool usable_ = false;
  bool done_ = false;
};

}  // namespace

std::filesystem::path companion_folder(const std::filesystem::path& path) {
  std::error_code not_there;
  const std::filesystem::path real = std::filesystem::canonical(path, not_there);
  return (not_there ? std::filesystem::absolute(path) : real).parent_path();
}

std::string read_bytes(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) refuse(path, "it is a folder, not a file");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  const std::uintmax_t size = std::filesystem::file_size(path, ignored);
  if (!file || ignored) {
    refuse(path, fmt::format("it cannot be read ({}); check the path and its permissions",
                             errno == 0 ? "not a regular file" : std::strerror(errno)));
  }
  if (size == 0) refuse(path, "the file is empty; export the mesh again");
  if (size > kLargestMeshFile) refuse_size(path);
  std::string bytes(size, '\0');
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size))) {
    refuse(path, "reading it failed half-way; try a copy on another disk");
  }
  return bytes;
}

std::string gunzip(std::string_view packed, const std::filesystem::path& path) {
  Inflation inflation(packed);
  std::string bytes;
  std::size_t used = 0;
  while (!inflation.done()) {
    if (bytes.size() - used < packed.size()) bytes.resize(bytes.size() + 4 * packed.size() + 4096);
    used += inflation.fill(bytes.data() + used, bytes.size() - used);
    if (inflation.damaged()) {
      refuse(path, "its gzip data is damaged or cut off; get the file again");
    }
    if (used > kLargestMeshFile) refuse_size(path);
  }
  bytes.resize(used);
  if (bytes.empty()) refuse(path, "it unpacks to an empty file; export the mesh again");
  return bytes;
}

}  // namespace beambench

#include "scenes/formats/mesh/mesh_file.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <new>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"

namespace beambench::scenes::mesh {
namespace {

constexpr std::string_view kGzip = ".gz";
constexpr std::array<std::string_view, 14> kEndings{"3ds", "ac",  "ase",  "blend", "dae",
                                                    "fbx", "glb", "gltf", "lwo",   "obj",
                                                    "off", "ply", "stl",  "x3d"};
constexpr std::array<std::string_view, 17> kForeign{"3dm", "abc",  "c4d",  "iges", "igs",  "jobj",
                                                    "ma",  "max",  "mb",   "skp",  "step", "stp",
                                                    "usd", "usda", "usdc", "usdz", "wrl"};

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

/// Returns the ending after the last dot, in lower case; a final `.gz` does not count.
std::string last_ending(std::string_view file_name) {
  if (is_gzipped(file_name)) file_name.remove_suffix(kGzip.size());
  const std::size_t dot = file_name.find_last_of("./");
  if (dot == std::string_view::npos || file_name[dot] != '.') return {};
  return lower_case(file_name.substr(dot + 1));
}

template <typename List>
bool contains(const List& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

[[noreturn]] void refuse(const std::filesystem::path& path, std::string_view why) {
  throw InputError(fmt::format("{}: {}", path.string(), why));
}

[[noreturn]] void refuse_size(const std::filesystem::path& path) {
  refuse(path, "it holds more than 4 GiB; split it, or reduce its triangles");
}

/// The state of zlib while it reads one gzip file.
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

  /// Fills the buffer as far as possible. Returns the number of bytes.
  std::size_t fill(char* buffer, std::size_t size) {
    stream_.next_out = reinterpret_cast<Bytef*>(buffer);
    stream_.avail_out = limited(size);
    const std::size_t wanted = stream_.avail_out;
    while (usable_ && !done_ && stream_.avail_out > 0) step();
    return wanted - stream_.avail_out;
  }
  /// Returns the number of packed bytes left.
  std::size_t packed_left() const { return packed_.size(); }
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
      if (!done_ && inflateReset(&stream_) != Z_OK) fail();  // gzip files may be concatenated
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

/// Unpacks block by block, so that little more than the accepted data is in memory.
std::string unpacked(std::string_view packed, const std::filesystem::path& path) {
  constexpr std::size_t kBlock = std::size_t{4} << 20U;
  constexpr std::size_t kSmall = std::size_t{64} << 20U;
  constexpr std::size_t kLargestRatio = 200;  // text compresses 10-fold; gzip's maximum is 1032
  Inflation inflation(packed);
  std::string bytes;
  while (!inflation.done()) {
    const std::size_t used = bytes.size();
    bytes.resize(used + kBlock);
    bytes.resize(used + inflation.fill(bytes.data() + used, kBlock));
    if (inflation.damaged()) {
      refuse(path, "its gzip data is damaged or cut off; get the file again");
    }
    if (bytes.size() > kLargestMeshFile) refuse_size(path);
    const std::size_t taken = packed.size() - inflation.packed_left();
    if (bytes.size() > kSmall && bytes.size() / kLargestRatio > taken) {
      refuse(path, fmt::format("its first {} bytes unpack to {}, more than {} times as many, which "
                               "no mesh does; unpack it yourself if it is one",
                               taken, bytes.size(), kLargestRatio));
    }
  }
  return bytes;
}

}  // namespace

bool is_gzipped(std::string_view file_name) { return lower_case(file_name).ends_with(kGzip); }

std::string mesh_ending(std::string_view file_name) {
  const std::string ending = last_ending(file_name);
  return contains(kEndings, ending) ? ending : std::string();
}

bool is_foreign_model(std::string_view path) {
  return path.find('/') != std::string_view::npos && contains(kForeign, last_ending(path));
}

void refuse_foreign_model(std::string_view path) {
  throw InputError(
      fmt::format("'{}': .{} files cannot be read; convert it to one of: {} (or write it as NFF)",
                  path, last_ending(path), fmt::join(kEndings, ", ")));
}

std::filesystem::path companion_folder(const std::filesystem::path& path) {
  std::error_code not_there;
  const std::filesystem::path real = std::filesystem::canonical(path, not_there);
  return (not_there ? std::filesystem::absolute(path) : real).parent_path();
}

std::string read_bytes(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  std::error_code unknown;
  const fs::file_status status = fs::status(path, unknown);
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) {
    refuse(path, "it is not a regular file; meshes can be read only from regular files");
  }
  if (fs::is_regular_file(status) && fs::file_size(path, unknown) > kLargestMeshFile && !unknown) {
    refuse_size(path);
  }
  std::string bytes = read_input(path, kLargestMeshFile);
  if (bytes.empty()) refuse(path, "the file is empty; export the mesh again");
  return bytes;
}

std::string gunzip(std::string_view packed, const std::filesystem::path& path) {
  try {
    std::string bytes = unpacked(packed, path);
    if (!bytes.empty()) return bytes;
  } catch (const std::bad_alloc&) {
    refuse(path, "there is not enough memory to unpack it; close other programs");
  }
  refuse(path, "it unpacks to an empty file; export the mesh again");
}

Orientation usual_orientation(std::string_view ending) {
  if (ending == "stl") return {{0.0, 0.0, 1.0}, {0.0, -1.0, 0.0}};
  return {};
}

std::optional<glm::dvec3> parse_axis(std::string_view text) {
  const double sign = text.starts_with('-') ? -1.0 : 1.0;
  if (sign < 0.0) text.remove_prefix(1);
  if (text == "x") return glm::dvec3(sign, 0.0, 0.0);
  if (text == "y") return glm::dvec3(0.0, sign, 0.0);
  if (text == "z") return glm::dvec3(0.0, 0.0, sign);
  return std::nullopt;
}

}  // namespace beambench::scenes::mesh

#include "scenes/formats/mesh/mesh_cache.hpp"

#define XXH_INLINE_ALL

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <new>
#include <ostream>
#include <stdexcept>

#include <fmt/format.h>
#include <xxhash.h>

#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"

namespace beambench::scenes::mesh {
namespace {

/// Returns the path in an environment variable; an empty one counts as unset.
std::optional<std::filesystem::path> place(const char* variable) {
  const char* value = std::getenv(variable);
  if (value == nullptr || *value == '\0') return std::nullopt;
  return value;
}

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "beambench mesh 3";  // incremented whenever the layout changes
constexpr std::string_view kAnyMagic = kMagic.substr(0, kMagic.size() - 1);

/// The start of a file: its type, and what must follow.
struct Header {
  char magic[16];
  std::uint64_t size;
  std::uint64_t hash;
};

/// Returns whether a companion is the same as when the mesh was read.
bool is_unchanged(const MeshCompanion& companion, const fs::path& mesh_folder) {
  std::uint64_t hash = 0;
  try {
    hash = content_hash(read_bytes(mesh_folder / companion.path));
  } catch (const InputError&) {  // it is missing, perhaps as when the mesh was read
  }
  return hash == companion.hash;
}

bool are_unchanged(const std::vector<MeshCompanion>& companions, const fs::path& mesh_folder) {
  return std::all_of(companions.begin(), companions.end(), [&](const MeshCompanion& companion) {
    return is_unchanged(companion, mesh_folder);
  });
}

fs::path file_of(const fs::path& folder, const std::string& key) {
  return folder / (key + ".mesh");
}

/// Computes XXH3 of bytes that arrive in parts.
class RunningHash {
 public:
  RunningHash() : state_(XXH3_createState()) {
    if (!state_) throw std::bad_alloc();
    XXH3_64bits_reset(state_.get());
  }
  void add(const char* bytes, std::size_t count) { XXH3_64bits_update(state_.get(), bytes, count); }
  std::uint64_t value() const { return XXH3_64bits_digest(state_.get()); }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> state_;
};

void read_fully(InputStream& file, char* into, std::size_t count) {
  if (file.read({into, count}) < count) throw std::out_of_range("the file ends too early");
}

/// Thrown for a file that was written by an earlier version.
struct OtherLayout {};

/// Reads the mesh in a file after verifying that the file is unchanged.
ImportedMesh read_mesh(const fs::path& path) {
  InputStream file(path);
  Header header{};
  read_fully(file, reinterpret_cast<char*>(&header), sizeof(header));
  const std::string_view magic(header.magic, sizeof(header.magic));
  if (magic.starts_with(kAnyMagic) && magic.back() >= '1' && magic.back() < kMagic.back()) {
    throw OtherLayout();
  }
  if (magic != kMagic || file.remaining() != header.size) {
    throw std::out_of_range("its header is wrong");
  }
  RunningHash hash;
  ImportedMesh mesh = decode(
      [&](char* into, std::size_t count) {
        read_fully(file, into, count);
        hash.add(into, count);
      },
      header.size);
  if (hash.value() != header.hash || file.remaining() != std::uint64_t{0}) {
    throw std::out_of_range("its checksum is wrong");
  }
  return mesh;
}

/// Returns the header that precedes a mesh in its file.
Header header_of(const ImportedMesh& mesh) {
  Header header{};
  std::copy(kMagic.begin(), kMagic.end(), header.magic);
  RunningHash hash;
  encode(mesh, [&](const char* bytes, std::size_t count) {
    hash.add(bytes, count);
    header.size += count;
  });
  header.hash = hash.value();
  return header;
}

}  // namespace

std::optional<std::filesystem::path> cache_folder() {
  if (const auto own = place("BEAMBENCH_CACHE")) return own;
  if (const auto user = place("XDG_CACHE_HOME")) return *user / "beambench";
  if (const auto home = place("HOME")) return *home / ".cache" / "beambench";
  return std::nullopt;
}

std::uint64_t content_hash(std::string_view bytes) {
  return XXH3_64bits(bytes.data(), bytes.size());
}

std::string mesh_key(std::string_view bytes, std::string_view ending, std::string_view importer) {
  return fmt::format("{:016x}-{}-{}-{}", content_hash(bytes), bytes.size(), ending, importer);
}

CachedMesh find_cached_mesh(const fs::path& folder, const std::string& key,
                            const fs::path& mesh_folder) {
  const fs::path path = file_of(folder, key);
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};
  try {
    CachedMesh cached{CachedMesh::State::kFound, read_mesh(path)};
    if (!are_unchanged(cached.mesh.companions, mesh_folder)) return {};
    return cached;
  } catch (const OtherLayout&) {
    return {};
  } catch (const InputError&) {
  } catch (const std::out_of_range&) {
  } catch (const std::bad_alloc&) {
  }
  return {CachedMesh::State::kDamaged, {}};
}

bool cache_mesh(const fs::path& folder, const std::string& key, const ImportedMesh& mesh) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return false;
  const Header header = header_of(mesh);
  try {
    write_file(file_of(folder, key), [&](std::ostream& file) {
      const auto write = [&](const char* bytes, std::size_t count) {
        file.write(bytes, static_cast<std::streamsize>(count));
      };
      write(reinterpret_cast<const char*>(&header), sizeof(header));
      encode(mesh, write);
    });
  } catch (const InputError&) {
    return false;
  }
  return true;
}

}  // namespace beambench::scenes::mesh

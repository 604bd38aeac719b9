#include "scenes/formats/mesh/mesh_cache.hpp"

#define XXH_INLINE_ALL

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <ostream>
#include <stdexcept>

#include <fmt/format.h>
#include <xxhash.h>

#include "scenes/core/error.hpp"
#include "scenes/core/files.hpp"
#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"

namespace beambench::scenes::mesh {
namespace {

/// An environment variable that names a place; one that is empty counts as not set.
std::optional<std::filesystem::path> place(const char* variable) {
  const char* value = std::getenv(variable);
  if (value == nullptr || *value == '\0') return std::nullopt;
  return value;
}

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "beambench mesh 1";  // counts up with the layout

/// The start of a file: what it is, and what must follow.
struct Header {
  char magic[16];
  std::uint64_t size;
  std::uint64_t hash;
};

/// Whether a companion is still what it was when the mesh was read.
bool is_unchanged(const MeshCompanion& companion, const fs::path& mesh_folder) {
  std::uint64_t hash = 0;
  try {
    hash = content_hash(read_bytes(mesh_folder / companion.path));
  } catch (const InputError&) {  // it is not there; perhaps it was not then, either
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

/// The payload of a file, checked against its header.
std::string_view checked_payload(std::string_view bytes) {
  Header header{};
  if (bytes.size() < sizeof(header)) throw std::out_of_range("the file ends too early");
  std::memcpy(&header, bytes.data(), sizeof(header));
  const std::string_view payload = bytes.substr(sizeof(header));
  const bool right = std::string_view(header.magic, sizeof(header.magic)) == kMagic &&
                     header.size == payload.size() && header.hash == content_hash(payload);
  if (!right) throw std::out_of_range("its checksum is wrong");
  return payload;
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

std::string mesh_key(std::string_view bytes, std::string_view ending, std::uint32_t importer) {
  return fmt::format("{:016x}-{}-{}-{}", content_hash(bytes), bytes.size(), ending, importer);
}

CachedMesh find_cached_mesh(const fs::path& folder, const std::string& key,
                            const fs::path& mesh_folder) {
  const fs::path path = file_of(folder, key);
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return {};
  try {
    const std::string bytes = read_bytes(path);
    CachedMesh cached{CachedMesh::State::kFound, decode(checked_payload(bytes))};
    if (!are_unchanged(cached.mesh.companions, mesh_folder)) return {};
    return cached;
  } catch (const InputError&) {
  } catch (const std::out_of_range&) {
  }
  return {CachedMesh::State::kDamaged, {}};
}

bool cache_mesh(const fs::path& folder, const std::string& key, const ImportedMesh& mesh) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return false;
  const std::string payload = encode(mesh);
  Header header{{}, payload.size(), content_hash(payload)};
  std::copy(kMagic.begin(), kMagic.end(), header.magic);
  const std::string_view start(reinterpret_cast<const char*>(&header), sizeof(header));
  try {
    write_file(file_of(folder, key), [&](std::ostream& file) {
      for (const std::string_view bytes : {start, std::string_view(payload)}) {
        file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      }
    });
  } catch (const InputError&) {
    return false;
  }
  return true;
}

}  // namespace beambench::scenes::mesh

#include "scenes/formats/mesh/mesh_cache.hpp"

#define XXH_INLINE_ALL
#include <algorithm>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>
#include <unistd.h>
#include <xxhash.h>

#include "scenes/core/error.hpp"
#include "scenes/formats/mesh/mesh_bytes.hpp"
#include "scenes/formats/mesh/mesh_codec.hpp"

namespace beambench::scenes::mesh {
namespace {

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

/// The payload of a file, if it is the one that its header tells of.
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

/// Writes header and payload into a new file beside the target and renames it.
bool write_beside(const fs::path& target, std::string_view header, std::string_view payload) {
  std::string beside = (target.parent_path() / ".mesh-XXXXXX").string();
  const int made = ::mkstemp(beside.data());
  if (made < 0) return false;
  ::close(made);
  std::ofstream file(beside, std::ios::binary);
  file.write(header.data(), static_cast<std::streamsize>(header.size()));
  file.write(payload.data(), static_cast<std::streamsize>(payload.size()));
  file.close();
  std::error_code error;
  if (file) fs::rename(beside, target, error);
  if (file && !error) return true;
  fs::remove(beside, error);
  return false;
}

}  // namespace

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
  return write_beside(file_of(folder, key), start, payload);
}

}  // namespace beambench::scenes::mesh

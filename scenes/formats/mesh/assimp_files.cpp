#include "scenes/formats/mesh/assimp_files.hpp"

#include <memory>

#include <assimp/MemoryIOWrapper.h>

#include "scenes/core/error.hpp"
#include "scenes/formats/mesh/mesh_bytes.hpp"
#include "scenes/formats/mesh/mesh_cache.hpp"

namespace beambench::scenes::mesh {
namespace {

/// The bytes of a companion; none when it cannot be read, which importers take as they like.
std::string companion_bytes(const std::string& name) {
  try {
    return read_bytes(name);
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace

AssimpFiles::AssimpFiles(std::string name, std::string_view bytes)
    : name_(std::move(name)), bytes_(bytes) {}

bool AssimpFiles::Exists(const char* name) const {
  std::error_code ignored;
  return name == name_ || std::filesystem::is_regular_file(name, ignored);
}

Assimp::IOStream* AssimpFiles::Open(const char* name, const char* mode) {
  if (std::string_view(mode).find_first_of("wa+") != std::string_view::npos) return nullptr;
  std::string_view bytes = bytes_;
  if (name != name_) {
    const auto [companion, is_new] = companions_.try_emplace(name);
    if (is_new) companion->second = companion_bytes(name);
    bytes = companion->second;
    if (bytes.empty()) return nullptr;
  }
  // Assimp hands it back to Close.
  return std::make_unique<Assimp::MemoryIOStream>(
             reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size())
      .release();
}

void AssimpFiles::Close(Assimp::IOStream* stream) {
  const std::unique_ptr<Assimp::IOStream> closed(stream);
}

std::vector<MeshCompanion> AssimpFiles::companions() const {
  const std::filesystem::path folder = std::filesystem::path(name_).parent_path();
  std::vector<MeshCompanion> list;
  for (const auto& [name, bytes] : companions_) {
    const std::string relative = std::filesystem::path(name).lexically_relative(folder).string();
    list.push_back({relative, bytes.empty() ? 0 : content_hash(bytes)});
  }
  return list;
}

}  // namespace beambench::scenes::mesh

// Mesh import by Assimp.

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/version.h>
#include <fmt/format.h>

#include "scenes/base/error.hpp"
#include "scenes/formats/mesh/importers.hpp"
#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/formats/mesh/mesh_cleaning.hpp"
#include "scenes/formats/mesh/mesh_companions.hpp"
#include "scenes/formats/mesh/mesh_import.hpp"

namespace beambench::scenes::mesh {
namespace {

/// Serves the mesh file from memory, and its companions, read-only. Must outlive all reads by
/// Assimp.
class AssimpFiles : public Assimp::IOSystem {
 public:
  /// Serves `bytes` as the mesh `name` in the folder of the companions. The bytes and the
  /// companions must outlive this object.
  AssimpFiles(std::string name, std::string_view bytes, MeshCompanions& companions)
      : name_(std::move(name)), bytes_(bytes), companions_(&companions) {}

  bool Exists(const char* name) const override {
    return name == name_ || companions_->has(relative(name));
  }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override;
  void Close(Assimp::IOStream* stream) override {
    const std::unique_ptr<Assimp::IOStream> closed(stream);
  }

 private:
  /// Assimp puts the mesh's folder before the names of companions.
  std::filesystem::path relative(const std::filesystem::path& name) const {
    return name.lexically_relative(companions_->folder());
  }
  /// Returns an empty string for a companion that cannot or must not be read; the consequence
  /// depends on Assimp's importer.
  std::string_view companion_bytes(const char* name) {
    try {
      return companions_->read(relative(name));
    } catch (const InputError&) {
      return {};
    }
  }

  std::string name_;
  std::string_view bytes_;
  MeshCompanions* companions_;
};

Assimp::IOStream* AssimpFiles::Open(const char* name, const char* mode) {
  if (std::string_view(mode).find_first_of("wa+") != std::string_view::npos) return nullptr;
  const std::string_view bytes = name == name_ ? bytes_ : companion_bytes(name);
  if (bytes.empty()) return nullptr;
  // Assimp passes the stream back to Close.
  return std::make_unique<Assimp::MemoryIOStream>(
             reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size())
      .release();
}

/// The version of this importer; increment it whenever this file or its callees read a mesh
/// differently.
constexpr int kOwnVersion = 2;

constexpr unsigned kSteps =
    aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType;

[[noreturn]] void refuse(const std::filesystem::path& path, std::string_view why,
                         std::string_view remedy) {
  throw InputError(fmt::format("{}: {}; {}", path.string(), why, remedy));
}

bool is_default(const aiMaterial& material) {
  aiString name;
  return material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS &&
         std::string_view(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME;
}

/// Returns a material's color and transparency. A black material with a texture gets an average
/// texture's gray.
Surface surface_of(const aiMaterial& material) {
  Surface surface = clay();
  aiColor3D color;
  if (is_default(material) || material.Get(AI_MATKEY_COLOR_DIFFUSE, color) != aiReturn_SUCCESS) {
    return surface;
  }
  const bool painted = material.GetTextureCount(aiTextureType_DIFFUSE) > 0;
  if (color.IsBlack() && painted) color = {0.5F, 0.5F, 0.5F};
  const auto in_range = [](float part) { return part >= 0.0F ? std::min(part, 1.0F) : 0.0F; };
  surface.color = {in_range(color.r), in_range(color.g), in_range(color.b)};
  float opacity = 1.0F;
  if (material.Get(AI_MATKEY_OPACITY, opacity) == aiReturn_SUCCESS) {
    surface.transmittance = 1.0F - in_range(opacity);
  }
  return surface;
}

/// Transfers one of Assimp's meshes. Returns how many of its faces are points or lines.
std::size_t collect(const aiMesh& mesh, MeshCollector& collector) {
  std::size_t others = 0;
  for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) {
    if (face.mNumIndices != 3) {
      ++others;
      continue;
    }
    std::array<glm::vec3, 3> corners{};
    for (unsigned i = 0; i < 3; ++i) {
      if (face.mIndices[i] >= mesh.mNumVertices) {
        throw InputError(
            fmt::format("a face has the vertex {}, but there are only {}; export the "
                        "mesh again",
                        face.mIndices[i], mesh.mNumVertices));
      }
      const aiVector3D& place = mesh.mVertices[face.mIndices[i]];
      corners[i] = {place.x, place.y, place.z};
    }
    collector.add(corners);
  }
  return others;
}

/// Reads the file with Assimp. Throws InputError with Assimp's message on failure.
const aiScene& read_scene(Assimp::Importer& importer, const std::string& name,
                          const std::filesystem::path& path) {
  constexpr const char* kRemedy = "export it again, or convert it to another format";
  try {
    const aiScene* scene = importer.ReadFile(name, kSteps);
    if (scene != nullptr) return *scene;
  } catch (const std::exception& error) {
    refuse(path, fmt::format("it cannot be read as a mesh ({})", error.what()), kRemedy);
  }
  refuse(path, fmt::format("it cannot be read as a mesh ({})", importer.GetErrorString()), kRemedy);
}

ImportedMesh import_by_assimp(std::string_view bytes, const std::string& ending,
                              const std::filesystem::path& path) {
  // Assimp derives the format from the name; the name of a packed file would end with .gz.
  MeshCompanions companions(path, bytes.size());
  const std::string name = (companions.folder() / ("mesh." + ending)).string();
  Assimp::Importer importer;
  // The importer owns the handler.
  importer.SetIOHandler(std::make_unique<AssimpFiles>(name, bytes, companions).release());
  const aiScene& scene = read_scene(importer, name, path);

  MeshCollector collector;
  std::size_t others = 0;
  try {  // prefixes errors with the file's name
    for (const aiMesh* mesh : std::span(scene.mMeshes, scene.mNumMeshes)) {
      const bool known = mesh->mMaterialIndex < scene.mNumMaterials;
      collector.set_surface(known ? surface_of(*scene.mMaterials[mesh->mMaterialIndex]) : clay());
      others += collect(*mesh, collector);
    }
    ImportedMesh result = collected_mesh(std::move(collector), others);
    result.companions = companions.list();
    return result;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace

Importer assimp_importer() {
  return {fmt::format("assimp-{}.{}-{}", aiGetVersionMajor(), aiGetVersionMinor(), kOwnVersion),
          import_by_assimp};
}

}  // namespace beambench::scenes::mesh

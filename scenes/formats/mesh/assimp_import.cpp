// Mesh import by Assimp.

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/version.h>
#include <fmt/format.h>

#include "scenes/core/error.hpp"
#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/formats/mesh/mesh_cache.hpp"
#include "scenes/formats/mesh/mesh_cleaning.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"
#include "scenes/formats/mesh/mesh_import.hpp"

namespace beambench::scenes::mesh {
namespace {

/// Serves the mesh file from memory and its companions from the disk, read-only, and notes which
/// companions were opened. Outlives what Assimp reads with it.
class AssimpFiles : public Assimp::IOSystem {
 public:
  /// The mesh is known as `name` and has these bytes, which must outlive this object.
  AssimpFiles(std::string name, std::string_view bytes);

  bool Exists(const char* name) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* mode) override;
  void Close(Assimp::IOStream* stream) override;

  /// The companions, relative to the mesh's folder.
  std::vector<MeshCompanion> companions() const;

 private:
  std::string name_;
  std::string_view bytes_;
  std::map<std::string, std::string> companions_;  // their bytes, by the name Assimp used
};

/// The bytes of a companion; none when it cannot be read; how that matters depends on the importer.
std::string companion_bytes(const std::string& name) {
  try {
    return read_bytes(name);
  } catch (const InputError&) {
    return {};
  }
}

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

/// Incremented whenever this file, or what it calls, reads a mesh differently.
constexpr std::uint32_t kOwnVersion = 1;

constexpr unsigned kSteps =
    aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType;

[[noreturn]] void refuse(const std::filesystem::path& path, std::string_view why,
                         std::string_view remedy) {
  throw InputError(fmt::format("{}: {}; {}", path.string(), why, remedy));
}

/// Of a mesh without materials: unpainted clay.
Surface clay() {
  return {.color = {0.80F, 0.74F, 0.66F}, .diffuse = 0.8F, .specular = 0.2F, .shine = 20.0F};
}

bool is_default(const aiMaterial& material) {
  aiString name;
  return material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS &&
         std::string_view(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME;
}

/// Color and transparency of a material. A black one with a texture is as gray as textures are on
/// average.
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

/// Moves one of Assimp's meshes over; how many of its faces are points and lines.
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

/// What Assimp makes of the file. Throws InputError with Assimp's message where that is nothing.
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

void warn_of(std::vector<std::string>& warnings, std::size_t count, std::string_view what,
             std::string_view more = "") {
  if (count > 0) warnings.push_back(fmt::format("{} {} left out{}", count, what, more));
}

}  // namespace

std::uint32_t importer_version() {
  return (kOwnVersion * 1000 + aiGetVersionMajor()) * 1000 + aiGetVersionMinor();
}

ImportedMesh import_mesh(std::string_view bytes, const std::string& ending,
                         const std::filesystem::path& path) {
  // Assimp learns the format from the name; a packed file's would say .gz.
  if (ending == "ply") require_complete_ply(bytes, path);
  const std::string name = (companion_folder(path) / ("mesh." + ending)).string();
  auto files = std::make_unique<AssimpFiles>(name, bytes);
  const AssimpFiles& opened = *files;
  Assimp::Importer importer;
  importer.SetIOHandler(files.release());  // the importer owns it now
  const aiScene& scene = read_scene(importer, name, path);

  MeshCollector collector;
  std::size_t others = 0;
  try {  // puts the file's name before an error of a triangle
    for (const aiMesh* mesh : std::span(scene.mMeshes, scene.mNumMeshes)) {
      const bool known = mesh->mMaterialIndex < scene.mNumMaterials;
      collector.set_surface(known ? surface_of(*scene.mMaterials[mesh->mMaterialIndex]) : clay());
      others += collect(*mesh, collector);
    }
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
  ImportedMesh result;
  warn_of(result.warnings, collector.degenerate(), "triangles without area were",
          fmt::format(", the first of them triangle {}", collector.first_degenerate()));
  warn_of(result.warnings, others, "points and lines were");
  result.mesh = std::move(collector).finish();
  result.companions = opened.companions();
  if (result.mesh.triangles.empty()) {
    const std::string left_out = fmt::format(
        "{}", result.warnings.empty() ? "it holds no faces at all" : result.warnings[0]);
    refuse(path, fmt::format("no triangle is in it ({})", left_out), "export the mesh's faces");
  }
  return result;
}

}  // namespace beambench::scenes::mesh

#include "scenes/formats/mesh/importers.hpp"

#include <utility>

#include <fmt/format.h>

#include "scenes/base/error.hpp"
#include "scenes/formats/mesh/mesh_import.hpp"

namespace beambench::scenes::mesh {
namespace {

Importer importer_for(std::string_view ending) {
  if (ending == "glb" || ending == "gltf") return gltf_importer();
  if (ending == "obj") return obj_importer();
  if (ending == "ply") return ply_importer();
  if (ending == "off") return off_importer();
  if (ending == "stl") return stl_importer();
  return assimp_importer();
}

void warn_of(std::vector<std::string>& warnings, std::size_t count, std::string_view what,
             std::string_view more = "") {
  if (count > 0) warnings.push_back(fmt::format("{} {} left out{}", count, what, more));
}

}  // namespace

std::string importer_of(std::string_view ending) { return importer_for(ending).name; }

ImportedMesh import_mesh(std::string_view bytes, const std::string& ending,
                         const std::filesystem::path& path) {
  return importer_for(ending).import(bytes, ending, path);
}

void refuse_missing_library(const std::filesystem::path& path, std::string_view library,
                            std::string_view package) {
  throw InputError(fmt::format(
      "{}: this build of beambench reads no meshes of this format, because {} was missing when it "
      "was built; install {}, configure afresh and build again (scripts/setup does both)",
      path.string(), library, package));
}

ImportedMesh with_file_name(const std::filesystem::path& path, std::string_view bytes,
                            ImportedMesh (*read)(std::string_view)) {
  try {
    return read(bytes);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

Surface clay() {
  return {.color = {0.80F, 0.74F, 0.66F}, .diffuse = 0.8F, .specular = 0.2F, .shine = 20.0F};
}

ImportedMesh collected_mesh(MeshCollector&& collector, std::size_t points_and_lines) {
  ImportedMesh result;
  warn_of(result.warnings, collector.degenerate(), "triangles without area were",
          fmt::format(", the first of them triangle {}", collector.first_degenerate()));
  warn_of(result.warnings, points_and_lines, "points and lines were");
  result.mesh = std::move(collector).finish();
  if (result.mesh.triangles.empty()) {
    throw InputError(fmt::format(
        "no triangle is in it ({}); export the mesh's faces",
        result.warnings.empty() ? std::string("it holds no faces at all") : result.warnings[0]));
  }
  return result;
}

}  // namespace beambench::scenes::mesh

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenes/base/error.hpp"
#include "scenes/base/plain_text.hpp"
#include "scenes/formats/mesh/importers.hpp"
#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/formats/mesh/mesh_cleaning.hpp"
#include "scenes/formats/mesh/mesh_companions.hpp"
#include "scenes/formats/mesh/obj_file.hpp"
#include "scenes/formats/mesh/obj_lines.hpp"
#include "scenes/formats/mesh/obj_materials.hpp"

namespace beambench::scenes::mesh {
namespace {

/// The version of this importer; increment it whenever OBJ files are read differently.
constexpr int kOwnVersion = 3;

/// Returns the surface of a material. `usemtl` may be followed by a comment, but a material's name
/// may also contain a '#'.
Surface surface_named(const std::string& name, const std::map<std::string, Surface>& surfaces) {
  auto found = surfaces.find(name);
  if (found == surfaces.end()) found = surfaces.find(std::string(without_comment(name)));
  return found == surfaces.end() ? clay() : found->second;
}

/// Adds all faces. Returns how many of them are points and lines.
std::size_t add_faces(ObjFile file, const std::map<std::string, Surface>& surfaces,
                      MeshCollector& collector) {
  std::size_t others = 0;
  SharedVertices vertices(std::move(file.vertices));
  collector.set_surface(clay());
  auto material = file.materials.begin();
  std::span<const std::uint32_t> rest(file.corners);
  for (std::size_t face = 0; face < file.face_sizes.size(); ++face) {
    for (; material != file.materials.end() && material->first == face; ++material) {
      collector.set_surface(surface_named(material->second, surfaces));
    }
    const auto corners = rest.first(file.face_sizes[face]);
    rest = rest.subspan(corners.size());
    if (corners.size() == 3) {
      collector.add(vertices, {corners[0], corners[1], corners[2]});
    } else if (corners.size() > 3) {
      collector.add_polygon(vertices, corners);
    } else {
      ++others;
    }
  }
  return others;
}

/// Returns warnings about the parts of the file that are not in the mesh.
std::vector<std::string> left_out(const ObjFile& file) {
  std::vector<std::string> warnings;
  if (!file.unknown.empty()) warnings.push_back(file.unknown.message());
  if (file.free_forms > 0) {
    warnings.push_back(
        fmt::format("{} free-form curves and surfaces were left out", file.free_forms));
  }
  return warnings;
}

ImportedMesh import_text(std::string_view text, MeshCompanions& companions) {
  ObjFile file = read_obj(text);
  std::vector<std::string> warnings = left_out(file);
  if (file.face_sizes.empty() && !file.unknown.empty()) {
    throw InputError(fmt::format("no face is in it ({}); export it again", warnings.front()));
  }
  const auto surfaces = obj_surfaces(file.libraries, companions, warnings);
  MeshCollector collector;
  collector.reserve(file.vertices.size(), file.face_sizes.size());
  const std::size_t points_and_lines = file.points_and_lines;
  const std::size_t others = add_faces(std::move(file), surfaces, collector);
  ImportedMesh result = collected_mesh(std::move(collector), others + points_and_lines);
  result.warnings.insert(result.warnings.end(), warnings.begin(), warnings.end());
  result.companions = companions.list();
  return result;
}

ImportedMesh import_obj(std::string_view bytes, const std::string&,
                        const std::filesystem::path& path) {
  MeshCompanions companions(path, bytes.size());
  const std::string_view text = plain_text(bytes, path.string());
  try {
    return import_text(text, companions);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace

Importer obj_importer() { return {fmt::format("obj-{}", kOwnVersion), import_obj}; }

}  // namespace beambench::scenes::mesh

// Mesh import by tinyobjloader, which is compiled here.
#define TINYOBJLOADER_IMPLEMENTATION

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <limits>
#include <map>
#include <span>
#include <streambuf>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <tiny_obj_loader.h>

#include "scenes/core/error.hpp"
#include "scenes/formats/mesh/importers.hpp"
#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/formats/mesh/mesh_cleaning.hpp"
#include "scenes/formats/mesh/mesh_companions.hpp"
#include "scenes/formats/mesh/obj_lines.hpp"
#include "scenes/formats/mesh/obj_materials.hpp"

namespace beambench::scenes::mesh {
namespace {

/// Incremented whenever this file, or what it calls, reads a mesh differently.
constexpr int kOwnVersion = 2;

/// A stream's view of bytes that are elsewhere.
class ByteBuffer : public std::streambuf {
 public:
  explicit ByteBuffer(std::string_view bytes) {
    char* start = const_cast<char*>(bytes.data());  // only read
    setg(start, start, start + bytes.size());
  }
};

/// What tinyobjloader calls back with: the file, but for the numbers of faces as it has them.
struct ObjFile {
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> corners;     ///< of all faces; out of range where the file's are
  std::vector<std::uint32_t> face_sizes;  ///< how many of them each face has
  std::vector<std::pair<std::size_t, std::string>> materials;  ///< from which face on
};

/// A vertex of a face from 0; one that is not there is left for later, when all are known.
std::uint32_t vertex_index(int index, std::size_t vertices_before) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  if (index > 0) return static_cast<std::uint32_t>(index) - 1;
  const std::int64_t place = static_cast<std::int64_t>(vertices_before) + index;
  return place >= 0 && index < 0 ? static_cast<std::uint32_t>(place) : kNone;
}

tinyobj::callback_t callbacks() {
  tinyobj::callback_t calls;
  calls.vertex_cb = [](void* user, float x, float y, float z, float) {
    static_cast<ObjFile*>(user)->vertices.emplace_back(x, y, z);
  };
  calls.index_cb = [](void* user, tinyobj::index_t* indices, int count) {
    ObjFile& file = *static_cast<ObjFile*>(user);
    for (const tinyobj::index_t& corner : std::span(indices, static_cast<std::size_t>(count))) {
      file.corners.push_back(vertex_index(corner.vertex_index, file.vertices.size()));
    }
    file.face_sizes.push_back(static_cast<std::uint32_t>(count));
  };
  calls.usemtl_cb = [](void* user, const char* name, int) {
    ObjFile& file = *static_cast<ObjFile*>(user);
    file.materials.emplace_back(file.face_sizes.size(), material_name(name));
  };
  return calls;
}

ObjFile read_file(std::string_view text, const ObjLines& lines) {
  ObjFile file;
  file.vertices.reserve(lines.vertices);
  file.face_sizes.reserve(lines.faces);
  file.corners.reserve(3 * lines.faces);
  ByteBuffer buffer(text);
  std::istream stream(&buffer);
  tinyobj::LoadObjWithCallback(stream, callbacks(), &file);
  return file;
}

void require_vertices(std::span<const std::uint32_t> corners, std::size_t vertices,
                      std::size_t face) {
  const auto wrong = std::find_if(corners.begin(), corners.end(),
                                  [&](std::uint32_t corner) { return corner >= vertices; });
  if (wrong == corners.end()) return;
  const std::string name = *wrong == std::numeric_limits<std::uint32_t>::max()
                               ? "a vertex before the first"
                               : fmt::format("the vertex {}", std::uint64_t{*wrong} + 1);
  throw InputError(
      fmt::format("it cannot be read as a mesh (face {} has {}, but there are {} vertices); export "
                  "it again",
                  face + 1, name, vertices));
}

/// Adds all faces; how many of them are points and lines.
std::size_t add_faces(ObjFile file, const std::map<std::string, Surface>& surfaces,
                      MeshCollector& collector) {
  std::size_t others = 0;
  SharedVertices vertices(std::move(file.vertices));
  collector.set_surface(clay());
  auto material = file.materials.begin();
  std::span<const std::uint32_t> rest(file.corners);
  for (std::size_t face = 0; face < file.face_sizes.size(); ++face) {
    for (; material != file.materials.end() && material->first == face; ++material) {
      const auto surface = surfaces.find(material->second);
      collector.set_surface(surface == surfaces.end() ? clay() : surface->second);
    }
    const auto corners = rest.first(file.face_sizes[face]);
    rest = rest.subspan(corners.size());
    require_vertices(corners, vertices.places().size(), face);
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

ImportedMesh import_text(std::string_view text, MeshCompanions& companions) {
  const std::string joined = joined_lines(text);
  if (!joined.empty()) text = joined;
  const ObjLines lines = obj_lines(text);
  std::vector<std::string> warnings;
  const auto surfaces = obj_surfaces(lines.libraries, companions, warnings);
  ObjFile file = read_file(text, lines);
  MeshCollector collector;
  collector.reserve(file.vertices.size(), file.face_sizes.size());
  const std::size_t others = add_faces(std::move(file), surfaces, collector);
  ImportedMesh result = collected_mesh(std::move(collector), others + lines.points_and_lines);
  if (lines.free_forms > 0) {
    result.warnings.push_back(
        fmt::format("{} free-form curves and surfaces were left out", lines.free_forms));
  }
  result.warnings.insert(result.warnings.end(), warnings.begin(), warnings.end());
  result.companions = companions.list();
  return result;
}

ImportedMesh import_by_tinyobj(std::string_view bytes, const std::string&,
                               const std::filesystem::path& path) {
  MeshCompanions companions(path, bytes.size());
  try {
    return import_text(bytes, companions);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace

Importer obj_importer() { return {fmt::format("tinyobj-{}", kOwnVersion), import_by_tinyobj}; }

}  // namespace beambench::scenes::mesh

#include "scenes/formats/mesh/indexed_faces.hpp"

#include <cstddef>
#include <span>
#include <utility>

#include "scenes/formats/mesh/importers.hpp"
#include "scenes/formats/mesh/mesh_cleaning.hpp"

namespace beambench::scenes::mesh {

ImportedMesh mesh_of(IndexedFaces&& faces) {
  MeshCollector collector;
  collector.reserve(faces.vertices.size(), faces.sizes.size());
  collector.set_surface(clay());
  SharedVertices vertices(std::move(faces.vertices));
  std::size_t points_and_lines = 0;
  std::span<const std::uint32_t> rest(faces.corners);
  for (const std::uint32_t size : faces.sizes) {
    const auto corners = rest.first(size);
    rest = rest.subspan(size);
    if (size == 3) {
      collector.add(vertices, {corners[0], corners[1], corners[2]});
    } else if (size > 3) {
      collector.add_polygon(vertices, corners);
    } else if (size > 0) {
      ++points_and_lines;
    }
  }
  return collected_mesh(std::move(collector), points_and_lines);
}

}  // namespace beambench::scenes::mesh

#include "scenes/generators/room/placed_piece.hpp"

#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/rotation.hpp"

namespace beambench {

glm::dmat4 standing_at(const glm::dvec3& place, double degrees) {
  return glm::translate(glm::dmat4(1.0), place) * rotation(2, degrees);
}

void PlacedPiece::flat(const Surface& surface, const PolygonMesh& mesh) {
  builder_.set_surface(surface);
  add_flat(builder_, transformed(mesh, place_));
}

void PlacedPiece::smooth(const Surface& surface, const PolygonMesh& mesh, double crease) {
  builder_.set_surface(surface);
  add_smooth(builder_, transformed(mesh, place_), {.crease = crease});
}

PolygonMesh above(PolygonMesh mesh, double z) {
  std::erase_if(mesh.polygons, [&](const PolygonMesh::Corners& corners) {
    return std::all_of(corners.begin(), corners.end(),
                       [&](std::uint32_t corner) { return mesh.vertices[corner].z < z; });
  });
  return mesh;
}

}  // namespace beambench

#include "scenes/generators/thesis/room/placed_piece.hpp"

#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>

#include "scenes/modelling/add_mesh.hpp"
#include "scenes/modelling/rotation.hpp"

namespace beambench::scenes::generators {

glm::dmat4 standing_at(const glm::dvec3& place, double degrees) {
  return glm::translate(glm::dmat4(1.0), place) * modelling::rotation(2, degrees);
}

void PlacedPiece::flat(const Surface& surface, const modelling::PolygonMesh& mesh) {
  builder_.set_surface(surface);
  modelling::add_flat(builder_, modelling::transformed(mesh, place_));
}

void PlacedPiece::smooth(const Surface& surface, const modelling::PolygonMesh& mesh,
                         double crease) {
  builder_.set_surface(surface);
  modelling::add_smooth(builder_, modelling::transformed(mesh, place_), {.crease = crease});
}

modelling::PolygonMesh above(modelling::PolygonMesh mesh, double z) {
  std::erase_if(mesh.polygons, [&](const modelling::PolygonMesh::Corners& corners) {
    return std::all_of(corners.begin(), corners.end(),
                       [&](std::uint32_t corner) { return mesh.vertices[corner].z < z; });
  });
  return mesh;
}

}  // namespace beambench::scenes::generators

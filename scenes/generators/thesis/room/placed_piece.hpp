#pragma once
// Pieces of furniture, each modelled around an origin of its own, put into the room.

#include <glm/mat4x4.hpp>

#include "scenes/modelling/polygon_mesh.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// Standing upright at a place, turned counter-clockwise seen from above.
glm::dmat4 standing_at(const glm::dvec3& place, double degrees = 0.0);

/// Adds meshes of one piece, moved to where it stands.
class PlacedPiece {
 public:
  PlacedPiece(SceneBuilder& builder, const glm::dmat4& place) : builder_(builder), place_(place) {}

  void flat(const Surface& surface, const modelling::PolygonMesh& mesh);
  void smooth(const Surface& surface, const modelling::PolygonMesh& mesh, double crease = 50.0);

 private:
  SceneBuilder& builder_;
  glm::dmat4 place_;
};

/// Without the polygons that lie below a height: what something stands on hides them.
modelling::PolygonMesh above(modelling::PolygonMesh mesh, double z);

}  // namespace beambench::scenes::generators

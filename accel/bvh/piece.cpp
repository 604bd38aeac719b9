#include "accel/bvh/piece.hpp"

namespace beambench::accel::bvh {

std::vector<Piece> collect_pieces(const scenes::Scene& scene) {
  std::vector<Piece> pieces;
  pieces.reserve(scene.triangles.size() + scene.spheres.size() + scene.cones.size());
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    const scenes::Primitive& primitive = scene.primitives[id];
    if (primitive.kind != scenes::PrimitiveKind::kPolygon) {
      pieces.push_back({id, primitive.index});
      continue;
    }
    const scenes::Polygon& polygon = scene.polygons[primitive.index];
    for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
      pieces.push_back({id, polygon.first_triangle + i});
    }
  }
  return pieces;
}

scenes::Bounds piece_bounds(const scenes::Scene& scene, const Piece& piece) {
  if (scene.primitives[piece.primitive].kind != scenes::PrimitiveKind::kPolygon) {
    return scenes::primitive_bounds(scene, piece.primitive);
  }
  scenes::Bounds bounds;
  for (const std::uint32_t vertex : scene.triangles[piece.index].vertex) {
    bounds.include(scene.vertices[vertex]);
  }
  return bounds;
}

}  // namespace beambench::accel::bvh

#include "scenes/subset.hpp"

#include <unordered_map>

namespace beambench::scenes {
namespace {

/// Copies primitives with everything that they refer to, each vertex once.
class Selection {
 public:
  Selection(const Scene& whole, Scene& part) : whole_(whole), part_(part) {}

  void add(PrimitiveId id) {
    Primitive primitive = whole_.primitives[id];
    switch (primitive.kind) {
      case PrimitiveKind::kSphere:
        part_.spheres.push_back(whole_.spheres[primitive.index]);
        primitive.index = static_cast<std::uint32_t>(part_.spheres.size() - 1);
        break;
      case PrimitiveKind::kCone:
        part_.cones.push_back(whole_.cones[primitive.index]);
        primitive.index = static_cast<std::uint32_t>(part_.cones.size() - 1);
        break;
      case PrimitiveKind::kPolygon:
        add_polygon(whole_.polygons[primitive.index]);
        primitive.index = static_cast<std::uint32_t>(part_.polygons.size() - 1);
        break;
    }
    part_.primitives.push_back(primitive);
  }

 private:
  void add_polygon(Polygon polygon) {
    const auto first_corner = static_cast<std::uint32_t>(part_.corners.size());
    const auto first_triangle = static_cast<std::uint32_t>(part_.triangles.size());
    for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
      part_.corners.push_back(vertex(whole_.corners[polygon.first_corner + i]));
    }
    for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
      Triangle triangle = whole_.triangles[polygon.first_triangle + i];
      for (std::uint32_t& each : triangle.vertex) each = vertex(each);
      triangle.primitive = static_cast<PrimitiveId>(part_.primitives.size());
      part_.triangles.push_back(triangle);
    }
    if (polygon.first_normal != Polygon::kFlat) {
      const auto first = whole_.normals.begin() + polygon.first_normal;
      polygon.first_normal = static_cast<std::uint32_t>(part_.normals.size());
      part_.normals.insert(part_.normals.end(), first, first + polygon.corner_count);
    }
    polygon.first_corner = first_corner;
    polygon.first_triangle = first_triangle;
    part_.polygons.push_back(polygon);
  }

  std::uint32_t vertex(std::uint32_t index) {
    auto& vertices = part_.vertices;
    const auto [found, is_new] =
        places_.emplace(index, static_cast<std::uint32_t>(vertices.size()));
    if (is_new) vertices.push_back(whole_.vertices[index]);
    return found->second;
  }

  const Scene& whole_;
  Scene& part_;
  std::unordered_map<std::uint32_t, std::uint32_t> places_;  ///< new index of each copied vertex
};

}  // namespace

Scene subset(const Scene& scene, std::span<const PrimitiveId> ids) {
  Scene part;
  part.name = scene.name;
  part.cameras = scene.cameras;
  part.background = scene.background;
  part.lights = scene.lights;
  part.surfaces = scene.surfaces;
  Selection selection(scene, part);
  for (const PrimitiveId id : ids) selection.add(id);
  const auto shrink = [](auto&... lists) { (lists.shrink_to_fit(), ...); };
  shrink(part.primitives, part.spheres, part.cones, part.polygons, part.triangles, part.vertices,
         part.corners, part.normals);
  part.bounds = bounds_of_all(part);
  return part;
}

}  // namespace beambench::scenes

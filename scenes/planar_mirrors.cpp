#include "scenes/planar_mirrors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include <glm/geometric.hpp>

namespace beambench::scenes {
namespace {

using glm::dvec3;

double size_of(const Scene& scene) { return glm::length(dvec3(scene.bounds.extent())); }

dvec3 corner_of(const Scene& scene, const Polygon& polygon, std::uint32_t corner) {
  return {scene.vertices[scene.corners[polygon.first_corner + corner]]};
}

/// Returns the unit vector along Newell's normal, whose components are twice the areas of the
/// polygon's projections along the axes.
dvec3 unit_normal(const Scene& scene, const Polygon& polygon) {
  dvec3 normal(0.0);
  for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
    const dvec3 from = corner_of(scene, polygon, i) - corner_of(scene, polygon, 0);
    const dvec3 to =
        corner_of(scene, polygon, (i + 1) % polygon.corner_count) - corner_of(scene, polygon, 0);
    normal += glm::cross(from, to);
  }
  return glm::normalize(normal);
}

bool is_flat(const Scene& scene, const Primitive& primitive) {
  return primitive.kind == PrimitiveKind::kPolygon &&
         scene.polygons[primitive.index].first_normal == Polygon::kFlat;
}

/// Returns whether corners and triangles lie in the mirror's plane; rays are reflected by the
/// triangles' own normals.
bool lies_in(const Scene& scene, const Polygon& polygon, const PlanarSurface& mirror) {
  constexpr double kTolerance = 0x1p-22;
  const double distance = kTolerance * double{scene.bounds.largest_coordinate()};
  const auto triangles =
      std::span(scene.triangles).subspan(polygon.first_triangle, polygon.triangle_count);
  return std::ranges::all_of(triangles, [&](const Triangle& triangle) {
    std::array<dvec3, 3> away{};
    for (std::size_t i = 0; i < 3; ++i) {
      away[i] = dvec3(scene.vertices[triangle.vertex[i]]) - mirror.point;
      if (std::abs(glm::dot(away[i], mirror.normal)) > distance) return false;
    }
    const dvec3 across = glm::normalize(glm::cross(away[1] - away[0], away[2] - away[0]));
    return glm::length(glm::cross(across, mirror.normal)) <= kTolerance;  // sine of their angle
  });
}

/// A cell of the space of planes: rounded normal and distance.
using PlaneCell = std::array<std::int64_t, 4>;

/// Returns the cell of a mirror's plane. Only planes in the same cell are compared, so that a
/// million small mirrors take little time. If a plane's polygons fall into two neighboring cells,
/// they form two mirrors that show the same image.
PlaneCell cell_of(const Scene& scene, const PlanarSurface& mirror) {
  constexpr double kNormals = 0x1p8;
  constexpr double kDistances = 0x1p10;
  dvec3 normal = mirror.normal;
  // Of a plane's two normals, the one whose first nonzero component is positive is used.
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(normal[axis]) < 0.5 / kNormals) continue;
    normal *= normal[axis] < 0.0 ? -1.0 : 1.0;
    break;
  }
  const dvec3 middle = 0.5 * (dvec3(scene.bounds.lower) + dvec3(scene.bounds.upper));
  const double distance = glm::dot(normal, mirror.point - middle) / size_of(scene);
  return {std::llround(kNormals * normal.x), std::llround(kNormals * normal.y),
          std::llround(kNormals * normal.z), std::llround(kDistances * distance)};
}

/// Combines coplanar flat polygons with the same group, `group_of(surface)`. Polygons for which it
/// returns nothing are left out.
template <class GroupOf>
std::vector<PlanarSurface> planar_surfaces(const Scene& scene, GroupOf group_of) {
  using Group = std::pair<std::uint32_t, PlaneCell>;
  std::vector<PlanarSurface> mirrors;
  std::map<Group, std::vector<std::size_t>> in_cell;  // mirror indices
  for (PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    if (!is_flat(scene, scene.primitives[id])) continue;
    const std::optional<std::uint32_t> group = group_of(scene.primitives[id].surface);
    if (!group) continue;
    const Polygon& polygon = scene.polygons[scene.primitives[id].index];
    PlanarSurface own{corner_of(scene, polygon, 0),
                      unit_normal(scene, polygon),
                      {id},
                      primitive_bounds(scene, id)};
    if (!lies_in(scene, polygon, own)) continue;  // the polygon is not flat
    std::vector<std::size_t>& near = in_cell[{*group, cell_of(scene, own)}];
    const auto same = std::ranges::find_if(
        near, [&](std::size_t i) { return lies_in(scene, polygon, mirrors[i]); });
    if (same != near.end()) {
      mirrors[*same].polygons.push_back(id);
      mirrors[*same].bounds.include(own.bounds);
    } else {
      near.push_back(mirrors.size());
      mirrors.push_back(std::move(own));
    }
  }
  return mirrors;
}

}  // namespace

std::vector<PlanarSurface> planar_mirrors(const Scene& scene) {
  return planar_surfaces(scene, [&](std::uint32_t surface) {
    return scene.surfaces[surface].specular > 0.0F ? std::optional(0U) : std::nullopt;
  });
}

std::vector<PlanarSurface> planar_glass(const Scene& scene) {
  return planar_surfaces(scene, [&](std::uint32_t surface) {
    return scene.surfaces[surface].transmittance > 0.0F ? std::optional(surface) : std::nullopt;
  });
}

}  // namespace beambench::scenes

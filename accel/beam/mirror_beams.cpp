#include "accel/beam/mirror_beams.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include <glm/geometric.hpp>

namespace beambench::accel::beam {
namespace {

using glm::dvec3;

double size_of(const scenes::Scene& scene) { return glm::length(dvec3(scene.bounds.extent())); }

dvec3 corner_of(const scenes::Scene& scene, const scenes::Polygon& polygon, std::uint32_t corner) {
  return {scene.vertices[scene.corners[polygon.first_corner + corner]]};
}

/// Newell's normal: twice the area of the polygon's projection along each axis.
dvec3 unit_normal(const scenes::Scene& scene, const scenes::Polygon& polygon) {
  dvec3 normal(0.0);
  for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
    const dvec3 from = corner_of(scene, polygon, i) - corner_of(scene, polygon, 0);
    const dvec3 to =
        corner_of(scene, polygon, (i + 1) % polygon.corner_count) - corner_of(scene, polygon, 0);
    normal += glm::cross(from, to);
  }
  return glm::normalize(normal);
}

bool is_planar_mirror(const scenes::Scene& scene, const scenes::Primitive& primitive) {
  if (primitive.kind != scenes::PrimitiveKind::kPolygon) return false;
  const scenes::Polygon& polygon = scene.polygons[primitive.index];
  return polygon.first_normal == scenes::Polygon::kFlat &&
         scene.surfaces[primitive.surface].specular > 0.0F;
}

bool lies_in(const scenes::Scene& scene, const scenes::Polygon& polygon, const PlanarMirror& mirror,
             double tolerance) {
  for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
    const dvec3 away = corner_of(scene, polygon, i) - mirror.point;
    if (std::abs(glm::dot(away, mirror.normal)) > tolerance) return false;
  }
  return true;
}

/// A cell of the space of planes: normal and distance, rounded.
using PlaneCell = std::array<std::int64_t, 4>;

/// Only planes in one cell are compared, so that a million small mirrors take little time. Two
/// halves of a plane that fall into neighboring cells are two mirrors, which show the same.
PlaneCell cell_of(const scenes::Scene& scene, const PlanarMirror& mirror) {
  constexpr double kNormals = 0x1p8;
  constexpr double kDistances = 0x1p10;
  dvec3 normal = mirror.normal;
  for (int axis = 0; axis < 3; ++axis) {  // a plane has two normals: the one whose first axis is up
    if (std::abs(normal[axis]) < 0.5 / kNormals) continue;
    normal *= normal[axis] < 0.0 ? -1.0 : 1.0;
    break;
  }
  const dvec3 middle = 0.5 * (dvec3(scene.bounds.lower) + dvec3(scene.bounds.upper));
  const double distance = glm::dot(normal, mirror.point - middle) / size_of(scene);
  return {std::llround(kNormals * normal.x), std::llround(kNormals * normal.y),
          std::llround(kNormals * normal.z), std::llround(kDistances * distance)};
}

}  // namespace

std::vector<PlanarMirror> planar_mirrors(const scenes::Scene& scene) {
  std::vector<PlanarMirror> mirrors;
  std::map<PlaneCell, std::vector<std::size_t>> in_cell;  // indices of mirrors
  const double tolerance = 0x1p-20 * size_of(scene);
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    if (!is_planar_mirror(scene, scene.primitives[id])) continue;
    const scenes::Polygon& polygon = scene.polygons[scene.primitives[id].index];
    PlanarMirror own{corner_of(scene, polygon, 0), unit_normal(scene, polygon), {id}};
    std::vector<std::size_t>& near = in_cell[cell_of(scene, own)];
    const auto same = std::ranges::find_if(
        near, [&](std::size_t i) { return lies_in(scene, polygon, mirrors[i], tolerance); });
    if (same != near.end()) {
      mirrors[*same].polygons.push_back(id);
    } else {
      near.push_back(mirrors.size());
      mirrors.push_back(std::move(own));
    }
  }
  return mirrors;
}

std::optional<MirrorView> view_in(const PlanarMirror& mirror, const scenes::Scene& scene,
                                  const PrimaryRays& rays, const HitBuffer& hits) {
  const dvec3 eye(rays.eye());
  const double side = glm::dot(eye - mirror.point, mirror.normal) > 0.0 ? 1.0 : -1.0;
  const dvec3 virtual_eye = mirror.point + mirrored(eye - mirror.point, mirror.normal);
  // The offset of rays that begin on other surfaces (harness/rays/normal.hpp).
  const dvec3 lift = side * 64.0 * 0x1p-24 *
                     (scene.bounds.largest_coordinate() + glm::length(virtual_eye)) * mirror.normal;
  MirrorView view{rays.mirrored(mirror.point, mirror.normal), virtual_eye + lift, {}, {}};
  rays.for_each(0, rays.height(), [&](std::size_t index, const Ray& ray) {
    const auto hit = hits.get(index);
    if (!hit) return;
    if (!std::binary_search(mirror.polygons.begin(), mirror.polygons.end(), hit->primitive)) return;
    const dvec3 direction(ray.direction);
    Ray& reflected = view.rays.emplace_back();
    reflected.origin = glm::vec3(eye + double{hit->t} * direction + lift);
    reflected.direction = glm::vec3(mirrored(direction, mirror.normal));
    view.samples.push_back(static_cast<std::uint32_t>(index));
  });
  if (view.rays.empty()) return std::nullopt;
  return view;
}

}  // namespace beambench::accel::beam

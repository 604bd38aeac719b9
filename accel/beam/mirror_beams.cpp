#include "accel/beam/mirror_beams.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
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

/// A convex cover of pixels: the image, cut along lines of 16 directions.
ImagePolygon cover(const std::vector<glm::dvec2>& corners) {
  ImagePolygon part;
  for (const glm::dvec2 corner :
       {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(1, 1), glm::dvec2(0, 1)}) {
    part.push_back(corner);
  }
  constexpr int kDirections = 16;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kDirections;
    const glm::dvec2 axis(std::cos(angle), std::sin(angle));
    double farthest = -1e30;
    for (const glm::dvec2& corner : corners) farthest = std::max(farthest, glm::dot(corner, axis));
    part = clip(part, {axis.x, axis.y, -farthest}, 1e-9);
  }
  return part;
}

/// The corners of the first and the last pixel of each row that sees the mirror.
std::vector<glm::dvec2> ends_of_rows(const HitBuffer& hits,
                                     const std::vector<std::uint8_t>& unwanted) {
  std::vector<glm::dvec2> corners;
  const glm::dvec2 pixels(hits.width(), hits.height());
  for (int y = 0; y < hits.height(); ++y) {
    int first = hits.width();
    int last = -1;
    for (int x = 0; x < hits.width(); ++x) {
      for (int sample = 0; sample < hits.samples(); ++sample) {
        if (unwanted[hits.index(x, y, sample)] != 0) continue;
        first = std::min(first, x);
        last = std::max(last, x);
      }
    }
    if (last < 0) continue;
    for (const int row : {y, y + 1}) {
      corners.push_back(glm::dvec2(first, row) / pixels);
      corners.push_back(glm::dvec2(last + 1, row) / pixels);
    }
  }
  return corners;
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
  std::vector<std::uint8_t> unwanted(hits.size(), 1);
  std::size_t samples = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const scenes::PrimitiveId id = hits.primitive()[i];
    if (!std::binary_search(mirror.polygons.begin(), mirror.polygons.end(), id)) continue;
    unwanted[i] = 0;
    ++samples;
  }
  if (samples == 0) return std::nullopt;
  const dvec3 eye(rays.eye());
  const double side = glm::dot(eye - mirror.point, mirror.normal) > 0.0 ? 1.0 : -1.0;
  const PrimaryRays behind = rays.mirrored(mirror.point, mirror.normal);
  // The offset of rays that begin on other surfaces (harness/rays/normal.hpp).
  const double lift =
      64.0 * 0x1p-24 * (scene.bounds.largest_coordinate() + glm::length(dvec3(behind.eye())));
  ImagePolygon part = cover(ends_of_rows(hits, unwanted));
  return MirrorView{
      BehindMirror(mirror.point, side * mirror.normal, lift, std::move(part), std::move(unwanted)),
      behind, samples};
}

Ray ray_behind(const MirrorView& view, int x, int y, int sample) {
  Ray ray = view.rays.ray(x, y, sample);
  view.sight.begin(ray);
  return ray;
}

}  // namespace beambench::accel::beam

#include "accel/beam/mirror_beams.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>

#include "accel/core/tolerance.hpp"

namespace beambench::accel::beam {
namespace {

using glm::dvec3;

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

std::optional<MirrorView> view_in(const scenes::PlanarMirror& mirror, const scenes::Scene& scene,
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
  ImagePolygon part = cover(ends_of_rows(hits, unwanted));
  return MirrorView{BehindMirror(mirror.point, side * mirror.normal, surface_lift(scene),
                                 std::move(part), std::move(unwanted)),
                    behind, samples};
}

Ray ray_behind(const MirrorView& view, int x, int y, int sample) {
  Ray ray = view.rays.ray(x, y, sample);
  view.sight.begin(ray);
  return ray;
}

}  // namespace beambench::accel::beam

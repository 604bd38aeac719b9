#include "accel/tile_beam/tile_view.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace beambench::accel::tile_beam {
namespace {

constexpr double kRounding = 0x1p-24;

}  // namespace

RasterView::RasterView(const SampleRaster& raster, const PrimaryRays& rays,
                       const scenes::Bounds& scene)
    : eye(rays.eye()),
      depth(rays.forward()),
      origin(raster.origin),
      right(raster.right),
      down(raster.down),
      per_angle_x(1.0 / glm::length(raster.right)),
      per_angle_y(1.0 / glm::length(raster.down)) {
  // right and down are perpendicular to each other and to forward, and forward . origin = 1.
  const glm::dvec3 across = right * (per_angle_x * per_angle_x);
  const glm::dvec3 along = down * (per_angle_y * per_angle_y);
  x = across - depth * glm::dot(across, origin);
  y = along - depth * glm::dot(along, origin);
  mirrored = glm::dot(glm::cross(x, y), depth) < 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double from = eye[axis];
    reach =
        std::max({reach, std::abs(scene.lower[axis] - from), std::abs(scene.upper[axis] - from)});
  }
}

TileView::TileView(const RasterView& raster, int tile_left, int tile_top, int tile_width,
                   int tile_height)
    : left(tile_left),
      top(tile_top),
      width(tile_width),
      height(tile_height),
      eye(raster.eye),
      exact_x(raster.x - raster.depth * static_cast<double>(tile_left)),
      exact_y(raster.y - raster.depth * static_cast<double>(tile_top)),
      exact_depth(raster.depth),
      right(raster.right),
      down(raster.down),
      mirrored(raster.mirrored),
      per_angle_x(raster.per_angle_x),
      per_angle_y(raster.per_angle_y) {
  x = exact_x;
  y = exact_y;
  depth = exact_depth;
  origin = raster.origin + raster.right * static_cast<double>(left) +
           raster.down * static_cast<double>(top);
  const double per_angle = std::max(raster.per_angle_x, raster.per_angle_y);
  guard = static_cast<float>(std::max(per_angle, 2.0 * kTileWidth));
  box_slack = static_cast<float>(8.0 * kRounding * guard);
  sliver = static_cast<float>(0.25 / std::min(raster.per_angle_x, raster.per_angle_y));
  // |p| is at most sqrt(3) x reach.
  const auto slack = [&](const glm::dvec3& row) {
    return static_cast<float>(16.0 * kRounding * glm::length(row) * raster.reach);
  };
  slack_x = std::max(slack(exact_x), slack(exact_x - exact_depth * static_cast<double>(width)));
  slack_y = std::max(slack(exact_y), slack(exact_y - exact_depth * static_cast<double>(height)));
  slack_depth = slack(exact_depth);
}

}  // namespace beambench::accel::tile_beam

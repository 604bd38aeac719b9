#include "accel/beam/crossing.hpp"

#include <algorithm>

#include <glm/geometric.hpp>

namespace beambench::accel::beam {

double direction_rounding(const PrimaryRays& rays) {
  double longest = 0.0;
  for (const double x : {0.0, 1.0}) {
    for (const double y : {0.0, 1.0}) {
      longest =
          std::max(longest, glm::length(rays.top_left() + rays.across() * x + rays.all_down() * y));
    }
  }
  // Each component is off by half a unit in the last place: sqrt(3) x 2^-25 of the length at most.
  return 0x1p-23 * longest;
}

EyeView::EyeView(const CellGrid& grid, const PrimaryRays& rays) : grid_(&grid) {
  const glm::dvec3& right = rays.across();
  const glm::dvec3& down = rays.all_down();
  const glm::dvec3& top_left = rays.top_left();
  for (int axis = 0; axis < 3; ++axis) {
    eye_[static_cast<std::size_t>(axis)] = rays.eye()[axis];
    direction_[static_cast<std::size_t>(axis)] = {right[axis], down[axis], top_left[axis]};
  }
  rounding_ = direction_rounding(rays);
  border_ = 2.0 * rounding_ / glm::dvec2(glm::length(right), glm::length(down));
}

EyeView::EyeView(const CellGrid& grid, const PrimaryRays& rays, const NearbyRays& nearby)
    : EyeView(grid, rays) {
  eye_ = {nearby.eye.x, nearby.eye.y, nearby.eye.z};
  beside_eye_ = nearby.beside_eye;
  margin_ = nearby.margin;
}

ImagePolygon EyeView::screen() const {
  ImagePolygon screen;
  screen.push_back({-border_.x, -border_.y});
  screen.push_back({1.0 + border_.x, -border_.y});
  screen.push_back({1.0 + border_.x, 1.0 + border_.y});
  screen.push_back({-border_.x, 1.0 + border_.y});
  return screen;
}

}  // namespace beambench::accel::beam

#include "accel/beam/crossing.hpp"

#include <algorithm>

namespace beambench {

EyeView::EyeView(const CellGrid& grid, const PrimaryRays& rays)
    : grid_(&grid),
      eye_(rays.eye()),
      top_left_(rays.top_left()),
      right_(rays.right() * static_cast<double>(rays.width())),
      down_(rays.down() * static_cast<double>(rays.height())) {
  double longest = 0.0;
  for (const glm::dvec2 corner :
       {glm::dvec2(0.0, 0.0), glm::dvec2(1.0, 0.0), glm::dvec2(0.0, 1.0), glm::dvec2(1.0, 1.0)}) {
    longest = std::max(longest, glm::length(direction(corner)));
  }
  // Each component is off by half a unit in the last place: sqrt(3) x 2^-25 of the length at most.
  rounding_ = 0x1p-23 * longest;
}

ImagePolygon EyeView::screen() const {
  const double x = 2.0 * rounding_ / glm::length(right_);
  const double y = 2.0 * rounding_ / glm::length(down_);
  ImagePolygon screen;
  screen.push_back({-x, -y});
  screen.push_back({1.0 + x, -y});
  screen.push_back({1.0 + x, 1.0 + y});
  screen.push_back({-x, 1.0 + y});
  return screen;
}

}  // namespace beambench

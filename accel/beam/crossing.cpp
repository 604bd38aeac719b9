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
  // Each component is off by at most half a unit in the last place: in total by at most sqrt(3) x
  // 2^-25 of the length.
  return 0x1p-23 * longest;
}

EyeView::EyeView(const CellGrid& grid, const PrimaryRays& rays) : grid_(&grid) {
  const glm::dvec3& right = rays.across();
  const glm::dvec3& down = rays.all_down();
  const glm::dvec3& top_left = rays.top_left();
  for (int axis = 0; axis < 3; ++axis) {
    eye_[static_cast<std::size_t>(axis)] = rays.eye()[axis];
    direction_[static_cast<std::size_t>(axis)] = {right[axis], down[axis], top_left[axis], 0.0};
  }
  rounding_ = direction_rounding(rays);
  border_ = 2.0 * rounding_ / glm::dvec2(glm::length(right), glm::length(down));
}

EyeView::EyeView(const CellGrid& grid, const PrimaryRays& rays, const NearbyRays& nearby)
    : EyeView(grid, rays) {
  eye_ = {nearby.eye.x, nearby.eye.y, nearby.eye.z};
  nearby_ = nearby;
}

/// Returns the line moved by the drift, and by the deviation. Proof: let the planes lie at
/// distances A and B in front of the eye, and let e(p) be the drift at a place p, D(p) the
/// direction there at view depth 1, and d the deviation. A ray that crosses `a` first, and `b` at a
/// view depth z behind its origin, is then at z D + e; this point is beyond A and at B, each up to
/// z d. If e_a <= A and e_b <= B, it follows that (A - e_a) D_b - (B - e_b) D_a <= (A - e_a + B -
/// e_b) d. The left side is a conic on the image. The line omits its quadratic part, which is at
/// most the drift times the radius of the places.
///
/// If the eye is next to a plane, the drift may exceed its distance from the plane. Then
/// `begin_beams` keeps only rays that either cross the plane before their origins or not at all,
/// and divides them by direction. For a ray that moves away from the plane, only the line without
/// drift is right, so the band covers both.
ImageLine EyeView::moved_outward(ImageLine line, const Crossing& a, const Crossing& b,
                                 double size) const {
  const auto at_center = [&](const Crossing& crossing) {
    const ImageLine& direction = direction_[static_cast<std::size_t>(crossing.axis)];
    return crossing.side * direction.at(nearby_->center);
  };
  const double of_a = at_center(b) * a.side / size;
  const double of_b = at_center(a) * b.side / size;
  const auto drift = [&](std::size_t way) {
    return of_b * nearby_->drift[way][b.axis] - of_a * nearby_->drift[way][a.axis];
  };
  const double x = drift(0);
  const double y = drift(1);
  line.x += x;
  line.y += y;
  double margin =
      nearby_->deviation + nearby_->drifted * (2.0 * nearby_->deviation + nearby_->radius) / size;
  if (eye_is_beside(a) || eye_is_beside(b)) {
    const glm::dvec3 direction(direction_[0].at(nearby_->center), direction_[1].at(nearby_->center),
                               direction_[2].at(nearby_->center));
    margin += 2.0 * nearby_->drifted * (glm::length(direction) + nearby_->radius) / size;
  }
  line.constant -= x * nearby_->center.x + y * nearby_->center.y + margin;
  line.band = 2.0 * margin;
  return line;
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

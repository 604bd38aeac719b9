#pragma once
// Determines which plane of the cell grid a ray from the eye crosses first. Beams are divided by
// nothing else.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include <glm/vec3.hpp>

#include "accel/beam/image_polygon.hpp"
#include "accel/core/cell_ray.hpp"
#include "accel/core/primary_rays.hpp"

namespace beambench::accel::beam {

/// A plane of the cell grid, crossed in the direction of `side` (+1 or -1 along the axis).
struct Crossing {
  std::int32_t index;
  std::int16_t axis;
  std::int16_t side;
};

/// Returns whether the ray makes crossing `a` before `b`. A crossing that the ray does not make
/// comes last. At equal t the lower axis is first, so that the crossings of a ray are totally
/// ordered and every division of beams by them is a partition, however close a ray passes to an
/// edge or vertex.
inline bool crosses_before(const CellRay& ray, const Crossing& a, const Crossing& b) {
  const auto t = [&](const Crossing& crossing) {
    return ray.step(crossing.axis) == crossing.side ? ray.plane_t(crossing.axis, crossing.index)
                                                    : std::numeric_limits<double>::infinity();
  };
  const double t_a = t(a);
  const double t_b = t(b);
  if (t_a != t_b) return t_a < t_b;
  return a.axis != b.axis ? a.axis < b.axis : a.side < b.side;
}

/// The minimum width of a part, in the units of `ImageLine`; the rays of a narrower part stay with
/// the neighboring part. They deviate by at most 10 scene diagonals x 2^-39, far less than the
/// widening of overlaps (`tolerance.hpp`), so no hit is lost, and rays that lie exactly in a cell's
/// face do not divide beams into slivers.
inline constexpr double kSliver = 0x1p-39;

/// Returns how far rounding to float may move a ray's direction, at view depth 1.
double direction_rounding(const PrimaryRays& rays);

/// Rays that are nearly those of an image. The lines of rays reflected by a planar mirror pass
/// through its virtual eye, up to rounding. The lines of rays refracted by a plane have no common
/// point, but they change smoothly across the image (Shinya, Takahashi and Naito, "Principles and
/// applications of pencil tracing", SIGGRAPH 1987), so the line of a sample passes near eye + drift
/// * (its place - center).
///
/// A point of a ray deviates from the place of its sample by an angle, expressed as a length at
/// view depth 1. Other lengths are in scene units.
struct NearbyRays {
  glm::dvec3 eye;
  glm::dvec2 center{0.0};  ///< a place on the image
  /// The change of the eye for a step across the image and down, perpendicular to the view.
  std::array<glm::dvec3, 2> drift{};
  double deviation = 0.0;           ///< the maximum, seen from the drifting eye
  double deviation_from_eye = 0.0;  ///< the maximum, seen from `eye`
  double beside_eye = 0.0;  ///< the maximum distance of the lines from `eye`; at least `drifted`
  double drifted = 0.0;     ///< the maximum distance of the drifting eye from `eye`
  double radius = 0.0;      ///< the maximum distance of a place from `center`, at view depth 1
  double nearest = 0.0;     ///< the minimum view depth at which a ray begins
};

/// The planes of a grid as seen from the camera.
class EyeView {
 public:
  /// Views the rays of the image themselves, which all pass through the eye.
  EyeView(const CellGrid& grid, const PrimaryRays& rays);
  /// Views nearby rays instead.
  EyeView(const CellGrid& grid, const PrimaryRays& rays, const NearbyRays& nearby);

  const CellGrid& grid() const { return *grid_; }
  double eye(int axis) const { return eye_[static_cast<std::size_t>(axis)]; }
  glm::dvec3 eye() const { return {eye_[0], eye_[1], eye_[2]}; }

  /// Returns `direction_rounding` of the image's rays.
  double rounding() const { return rounding_; }
  /// Returns the maximum deviation, seen from the eye, of any point of a ray from its sample's
  /// place.
  double deviation() const { return nearby_ ? nearby_->deviation_from_eye : rounding_; }
  /// Returns whether the lines may pass the eye on the other side of a plane. If so, the crossing
  /// of that plane at the eye is uncertain.
  bool eye_is_beside(const Crossing& crossing) const {
    return nearby_ && std::abs(distance(crossing)) <= 1.25 * nearby_->beside_eye;
  }
  /// Returns the whole image as a polygon, extended on all sides by the possible rounding of a
  /// border sample.
  ImagePolygon screen() const;

  /// Returns the distance of the plane in front of the eye in the direction of `side`; negative
  /// behind it.
  double distance(const Crossing& crossing) const {
    return crossing.side * (grid_->plane(crossing.axis, crossing.index) - eye(crossing.axis));
  }
  /// Returns the crossing of a plane, in the direction in which rays from the eye cross it.
  Crossing crossing_of(int axis, std::int32_t index) const {
    const bool beyond = grid_->plane(axis, index) >= eye(axis);
    return {index, static_cast<std::int16_t>(axis), static_cast<std::int16_t>(beyond ? 1 : -1)};
  }

  /// Returns the line on the image between the rays that cross `a` first (negative) and those that
  /// cross `b` first: the image of the edge shared by the two planes, as a plane through it and the
  /// eye. If a ray crosses neither, the sign is meaningless. Neither distance may be negative.
  ///
  /// For nearby rays the line is moved outward, so that its negative side covers all rays that
  /// cross `a` first and `b` behind their origins. Its band is twice as wide, so that all rays
  /// beyond the band cross `a` first.
  ImageLine line_before(const Crossing& a, const Crossing& b) const {
    const double distance_a = distance(a);
    const double distance_b = distance(b);
    const double size = distance_a + distance_b;
    // At t = 0, with the eye in both planes, the lower axis is first.
    if (!(size >= std::numeric_limits<double>::min()))
      return a.axis < b.axis ? along(a, -1.0) : along(b, 1.0);
    // t_a < t_b with t = distance / (side * direction), multiplied out.
    const ImageLine to_b = along(b, distance_a / size);
    const ImageLine to_a = along(a, distance_b / size);
    const ImageLine line{to_b.x - to_a.x, to_b.y - to_a.y, to_b.constant - to_a.constant, 0.0};
    return nearby_ ? moved_outward(line, a, b, size) : line;
  }
  /// Returns `line_before(b, a)`, given `line_before(a, b)`.
  static ImageLine other_side(const ImageLine& line) {
    return {-line.x, -line.y, -line.constant - line.band, line.band};
  }
  /// Returns whether all rays of a polygon, given the range of the line `line_before(a, b)` over
  /// it, cross `a` first, up to a sliver.
  static bool all_before(const ImageLine& line, const LineRange& range) {
    return range.high <= kSliver - line.band;
  }
  /// Returns whether all rays of the polygon cross `b` first, up to a sliver.
  static bool all_behind(const LineRange& range) { return range.low >= -kSliver; }
  /// Returns a line that is negative for nearby rays in the direction of the crossing. If the eye
  /// is beside the plane, these rays cross it before their origins.
  ImageLine line_toward(const Crossing& crossing) const {
    ImageLine line = along(crossing, -1.0);
    line.constant += nearby_->deviation + 2.5 * nearby_->beside_eye / nearby_->nearest;
    return line;
  }

 private:
  /// Returns the line adapted to nearby rays.
  ImageLine moved_outward(ImageLine line, const Crossing& a, const Crossing& b, double size) const;
  /// Returns `factor` times the speed of rays in the direction of a crossing.
  ImageLine along(const Crossing& crossing, double factor) const {
    const ImageLine& direction = direction_[static_cast<std::size_t>(crossing.axis)];
    const double signed_factor = crossing.side * factor;
    return {signed_factor * direction.x, signed_factor * direction.y,
            signed_factor * direction.constant, 0.0};
  }

  const CellGrid* grid_;
  std::array<double, 3> eye_;
  /// The components of the direction through a point of the image, at view depth 1.
  std::array<ImageLine, 3> direction_;
  double rounding_ = 0.0;
  std::optional<NearbyRays> nearby_;  ///< nothing for the image's own rays
  glm::dvec2 border_{0.0};
};

}  // namespace beambench::accel::beam

#pragma once
// Determines which plane of the cell grid a ray from the eye crosses first: beams are divided by
// this alone.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

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
/// comes last. At the same t the lower axis is first, so that the crossings of a ray have a total
/// order and every division of beams by them is a partition, however close to an edge or a vertex a
/// ray passes.
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

/// The minimum width of a part, in the units of `ImageLine`; the rays of a narrower one stay with
/// the neighboring part. They deviate by at most 10 scene diagonals x 2^-39, far less than overlaps
/// are widened by (`tolerance.hpp`), so no hit is lost, and rays that run exactly in a cell's face
/// do not divide beams into slivers.
inline constexpr double kSliver = 0x1p-39;

/// Returns how far rounding a ray's direction to float may move it, in units of view depth 1.
double direction_rounding(const PrimaryRays& rays);

/// Rays that are nearly those of an image, as reflected rays nearly come from a virtual eye: their
/// numbers are rounded at another origin, so their lines pass slightly beside the eye.
struct NearbyRays {
  glm::dvec3 eye;
  double beside_eye;  ///< maximum distance at which the lines pass the eye
  /// A ray crosses two planes in the same order as the line through the eye and its sample's place
  /// if that line passes the planes' common edge at a distance of at least `margin`, in units of
  /// view depth 1. This holds for crossings behind the ray's origin. The margin exceeds the
  /// deviation of the direction from the eye to any point of the ray from that line.
  double margin;
};

/// The planes of a grid as seen from the camera.
class EyeView {
 public:
  /// The view for the rays of the image themselves, which all pass through the eye.
  EyeView(const CellGrid& grid, const PrimaryRays& rays);
  /// The view for nearby rays in their place.
  EyeView(const CellGrid& grid, const PrimaryRays& rays, const NearbyRays& nearby);

  const CellGrid& grid() const { return *grid_; }
  double eye(int axis) const { return eye_[static_cast<std::size_t>(axis)]; }
  glm::dvec3 eye() const { return {eye_[0], eye_[1], eye_[2]}; }

  /// `direction_rounding` of the image's rays.
  double rounding() const { return rounding_; }
  /// The maximum deviation of the direction from the eye to any point of a ray from its sample's
  /// place.
  double deviation() const { return std::max(rounding_, margin_); }
  /// Returns whether lines may pass the eye on the other side of a plane. If so, its crossing at
  /// the eye is uncertain.
  bool eye_is_beside(const Crossing& crossing) const {
    return std::abs(distance(crossing)) < 4.0 * beside_eye_;
  }
  /// Returns the whole image as a polygon, extended on all sides by the possible rounding of a
  /// border sample.
  ImagePolygon screen() const;

  /// Returns the distance of the plane in front of the eye in the direction of `side`; negative
  /// behind it.
  double distance(const Crossing& crossing) const {
    return crossing.side * (grid_->plane(crossing.axis, crossing.index) - eye(crossing.axis));
  }
  /// Returns the crossing of a plane by the rays that do cross it.
  Crossing crossing_of(int axis, std::int32_t index) const {
    const bool beyond = grid_->plane(axis, index) >= eye(axis);
    return {index, static_cast<std::int16_t>(axis), static_cast<std::int16_t>(beyond ? 1 : -1)};
  }

  /// The line on the image between the rays that cross `a` first (negative) and those that cross
  /// `b` first: the image of the edge that the two planes share, as a plane through it and the eye,
  /// moved inward by the margin of nearby rays. If a ray crosses neither, the sign is meaningless.
  /// Neither distance is negative.
  ImageLine line_before(const Crossing& a, const Crossing& b) const {
    const double distance_a = distance(a);
    const double distance_b = distance(b);
    const double size = distance_a + distance_b;
    // At t = 0, with the eye in both planes, the lower axis is first.
    if (size == 0.0) return a.axis < b.axis ? along(a, -1.0) : along(b, 1.0);
    // t_a < t_b with t = distance / (side * direction), multiplied out.
    const ImageLine to_b = along(b, distance_a / size);
    const ImageLine to_a = along(a, distance_b / size);
    return {to_b.x - to_a.x, to_b.y - to_a.y, to_b.constant - to_a.constant + margin_};
  }
  /// `line_before(b, a)` from `line_before(a, b)`.
  ImageLine other_side(const ImageLine& line) const {
    return {-line.x, -line.y, 2.0 * margin_ - line.constant};
  }
  /// Returns whether all rays of a polygon, given the range of `line_before(a, b)` over it, cross
  /// `a` first, up to a sliver.
  static bool all_before(const LineRange& range) { return range.high <= kSliver; }
  /// Returns whether they all cross `b` first.
  bool all_behind(const LineRange& range) const { return range.low >= 2.0 * margin_ - kSliver; }
  /// Returns a line that is negative for the rays in the direction of the crossing, by more than
  /// the margin.
  ImageLine line_toward(const Crossing& crossing) const {
    ImageLine line = along(crossing, -1.0);
    line.constant += margin_;
    return line;
  }

 private:
  /// Returns `factor` times the speed of rays in the direction of a crossing.
  ImageLine along(const Crossing& crossing, double factor) const {
    const ImageLine& direction = direction_[static_cast<std::size_t>(crossing.axis)];
    const double signed_factor = crossing.side * factor;
    return {signed_factor * direction.x, signed_factor * direction.y,
            signed_factor * direction.constant};
  }

  const CellGrid* grid_;
  std::array<double, 3> eye_;
  /// Each component of the direction through a point of the image, at view depth 1.
  std::array<ImageLine, 3> direction_;
  double rounding_ = 0.0;
  double beside_eye_ = 0.0;
  double margin_ = 0.0;
  glm::dvec2 border_{0.0};
};

}  // namespace beambench::accel::beam

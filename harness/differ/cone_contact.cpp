#include "harness/differ/cone_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace beambench {
namespace {

using glm::dvec3;

constexpr double kFar = std::numeric_limits<double>::infinity();

/// A cone as a profile turned round its axis: radius(h) = base_radius + slope h, 0 <= h <= height.
struct Profile {
  explicit Profile(const Cone& cone) : base(cone.base), base_radius(cone.base_radius) {
    const dvec3 span = dvec3(cone.apex) - base;
    height = glm::length(span);
    axis = span / height;
    slope = (static_cast<double>(cone.apex_radius) - cone.base_radius) / height;
    slant = std::sqrt(1.0 + slope * slope);
  }

  double height_of(const dvec3& point) const { return glm::dot(point - base, axis); }
  double radius_at(double h) const { return base_radius + slope * h; }
  /// The unit vector from the axis to the point; any one for a point on the axis.
  dvec3 outward(const dvec3& point) const {
    const dvec3 offset = point - base;
    const dvec3 radial = offset - glm::dot(offset, axis) * axis;
    const double length = glm::length(radial);
    return length > 0.0 ? radial / length : dvec3(0.0);
  }
  double distance_from_axis(const dvec3& point) const {
    const dvec3 offset = point - base;
    return glm::length(offset - glm::dot(offset, axis) * axis);
  }
  /// Distance of a point from the surface continued beyond its rims; negative inside.
  double signed_distance(const dvec3& point) const {
    return (distance_from_axis(point) - radius_at(height_of(point))) / slant;
  }
  /// The rim's point on the same side of the axis as `point`.
  dvec3 rim_point(const dvec3& point, double rim_height) const {
    return base + rim_height * axis + radius_at(rim_height) * outward(point);
  }

  dvec3 base;
  dvec3 axis;
  double base_radius, height, slope, slant;
};

/// The line in the quadric of the cone: a t^2 + 2 b t + c, t counted from the line's point closest
/// to the frustum's middle.
struct LineEquation {
  LineEquation(const RayLine& line, const Profile& profile) : direction(line.direction) {
    const dvec3 middle = profile.base + 0.5 * profile.height * profile.axis;
    start = middle - line.across(middle);
    const double along = glm::dot(direction, profile.axis);
    const double r = profile.radius_at(profile.height_of(start));
    const double r_slope = profile.slope * along;
    const dvec3 offset = start - profile.base;
    const dvec3 radial = offset - glm::dot(offset, profile.axis) * profile.axis;
    const dvec3 radial_slope = direction - along * profile.axis;
    a = glm::dot(radial_slope, radial_slope) - r_slope * r_slope;
    b = glm::dot(radial, radial_slope) - r * r_slope;
    c = glm::dot(radial, radial) - r * r;
  }
  dvec3 at(double t) const { return start + t * direction; }

  dvec3 start;
  dvec3 direction;
  double a, b, c;
};

/// How near the line comes to touching the surface without crossing it, or to having its entry and
/// exit in one point.
double silhouette_distance(const RayLine& line, const Profile& profile) {
  const LineEquation equation(line, profile);
  if (equation.a == 0.0) return kFar;
  const dvec3 turning_point = equation.at(-equation.b / equation.a);
  const double h = profile.height_of(turning_point);
  if (!(0.0 <= h && h <= profile.height)) return kFar;
  return std::abs(profile.signed_distance(turning_point));
}

/// The distance from the line to a rim: exact where the line crosses the rim's plane or the cone's
/// surface close to the rim, which is where it is asked for.
double rim_distance(const RayLine& line, const Profile& profile, double rim_height) {
  const LineEquation equation(line, profile);
  double nearest = kFar;
  const auto consider = [&](double t) {
    if (!std::isfinite(t)) return;
    nearest = std::min(nearest, line.distance_to(profile.rim_point(equation.at(t), rim_height)));
  };
  const double along = glm::dot(line.direction, profile.axis);
  consider((rim_height - profile.height_of(equation.start)) / along);
  const double discriminant = equation.b * equation.b - equation.a * equation.c;
  if (discriminant >= 0.0) {
    const double q = -(equation.b + std::copysign(std::sqrt(discriminant), equation.b));
    consider(q / equation.a);
    consider(equation.c / q);
  }
  return nearest;
}

}  // namespace

double cone_boundary_distance(const RayLine& line, const Cone& cone) {
  const Profile profile(cone);
  return std::min({silhouette_distance(line, profile), rim_distance(line, profile, 0.0),
                   rim_distance(line, profile, profile.height)});
}

Contact cone_contact(const RayLine& line, const dvec3& point, const Cone& cone, double grazing) {
  const Profile profile(cone);
  const double h = profile.height_of(point);
  const double within = std::clamp(h, 0.0, profile.height);
  double offset = std::abs(profile.signed_distance(point));
  if (h != within) {
    offset = std::max(offset, line.distance_to(profile.rim_point(point, within)));
  }
  const dvec3 normal = (profile.outward(point) - profile.slope * profile.axis) / profile.slant;
  const double outward = glm::dot(normal, line.direction);
  Contact found{offset, std::abs(outward), outward > 0.0};
  if (cone.inside_only && !found.leaving && cone_boundary_distance(line, cone) > grazing) {
    found.offset = kFar;
  }
  return found;
}

}  // namespace beambench

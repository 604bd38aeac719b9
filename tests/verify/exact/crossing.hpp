#pragma once
// Computes where the line of a ray crosses primitives.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "scenes/primitive.hpp"
#include "tests/verify/exact/ray.hpp"
#include "tests/verify/exact/shape.hpp"

namespace beambench::exact {

/// A surface and the line of a ray at one parameter `at`. For a sphere or a cone, whose equation
/// along the line is A s^2 + 2 B s + C = 0, `at.d` is B^2 - A C.
struct Crossing {
  Root at;
  bool curved;
  bool leaves;                  ///< for a sphere or cone: the ray leaves it here
  Number slack, slack_of_root;  ///< of a curved surface, see `is_across`
  double stretch;               ///< for a polygon: the length of the normal
  /// For a cone, its radius at the crossing; 0 at the apex, where the normal is undefined.
  double radius = std::numeric_limits<double>::infinity();
  scenes::PrimitiveId primitive = scenes::kNoPrimitive;

  /// Returns whether |s - at| |direction| |cos| <= within, where cos is the cosine of the angle
  /// between the ray and the surface normal at the crossing.
  bool is_across(const Number& s, double within) const {
    const Number offset = s * at.w - at.p;
    const Number limit(within * stretch);
    if (!curved) return offset.abs() <= limit;  // w is |normal . direction|
    // |s - at| sqrt(d) <= within N, both sides multiplied by w: w N = stretch (slack +
    // slack_of_root sqrt(d)), where |direction| |cos| = sqrt(d) / N.
    const Number rational = at.q * at.d;
    return sign_with_root(-rational - limit * slack, offset - limit * slack_of_root, at.d) <= 0 &&
           sign_with_root(-rational + limit * slack, offset + limit * slack_of_root, at.d) >= 0;
  }

  /// Returns whether |s - at| <= distance.
  bool is_along(const Number& s, double distance) const {
    return compare(at, s - Number(distance)) >= 0 && compare(at, s + Number(distance)) <= 0;
  }
};

/// Returns whether the line passes through the triangle, including its edges; false for a line in
/// its plane.
inline bool passes_through(const Triangle& triangle, const ExactRay& ray) {
  const Vector a = triangle.a - ray.origin;
  const Vector b = triangle.b - ray.origin;
  const Vector c = triangle.c - ray.origin;
  const int ab = dot(cross(a, b), ray.direction).sign();
  const int bc = dot(cross(b, c), ray.direction).sign();
  const int ca = dot(cross(c, a), ray.direction).sign();
  if (ab == 0 && bc == 0 && ca == 0) return false;
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

inline void add_crossings(const Polygon& polygon, const ExactRay& ray, std::vector<Crossing>& all) {
  for (const Triangle& triangle : polygon.triangles) {
    if (!passes_through(triangle, ray)) continue;
    const Number climb = dot(triangle.normal, ray.direction);
    const Number height = dot(triangle.normal, triangle.a - ray.origin);
    const Number sign(climb.sign());
    all.push_back({.at = {sign * height, {}, {}, climb.abs()},
                   .curved = false,
                   .leaves = false,
                   .slack = {},
                   .slack_of_root = {},
                   .stretch = length(triangle.normal)});
  }
}

inline void add_crossings(const Sphere& sphere, const ExactRay& ray, std::vector<Crossing>& all) {
  const Vector offset = ray.origin - sphere.center;
  const Number a = square(ray.direction);
  const Number b = dot(offset, ray.direction);
  const Number c = square(offset) - sphere.radius.squared();
  const Number d = b.squared() - a * c;
  if (d.sign() < 0) return;
  for (const bool leaves : {false, true}) {
    if (sphere.inside_only && !leaves) continue;
    all.push_back({.at = {-b, leaves ? 1.0 : -1.0, d, a},
                   .curved = true,
                   .leaves = leaves,
                   .slack = a * sphere.radius,
                   .slack_of_root = {},
                   .stretch = 1.0});
  }
}

/// The equation of a cone's surface along a line, times |axis|^4: a s^2 + 2 b s + c = 0. At a
/// crossing a s + b is negative where the line enters.
struct ConeEquation {
  ConeEquation(const Cone& cone, const Vector& origin, const Vector& direction)
      : offset(origin - cone.base),
        height(dot(offset, cone.axis)),
        climb(dot(direction, cone.axis)) {
    const Number length_4 = cone.length_2.squared();
    radius = cone.base_radius * cone.length_2 + cone.taper * height;
    widening = cone.taper * climb;
    a = square(direction) * length_4 - climb.squared() * cone.length_2 - widening.squared();
    b = dot(offset, direction) * length_4 - height * climb * cone.length_2 - radius * widening;
    c = square(offset) * length_4 - height.squared() * cone.length_2 - radius.squared();
  }

  Vector offset;            ///< from the base to the origin
  Number height, climb;     ///< along the axis: height + s climb, in units of 1 / |axis|
  Number radius, widening;  ///< at that height: radius + s widening, times |axis|^2
  Number a, b, c;
};

inline void add_cone_crossing(const Cone& cone, const ConeEquation& e, Root at, bool leaves,
                              std::vector<Crossing>& all) {
  if (cone.inside_only && !leaves) return;
  const Number height = e.height * at.w + e.climb * at.p;
  const Number height_of_root = e.climb * at.q;
  if (sign_with_root(height, height_of_root, at.d) < 0) return;
  if (sign_with_root(height - cone.length_2 * at.w, height_of_root, at.d) > 0) return;
  const Number slack = (e.radius * at.w + e.widening * at.p) * cone.length_2;
  const Number slack_of_root = e.widening * at.q * cone.length_2;
  const double radius = (slack.rounded() + slack_of_root.rounded() * std::sqrt(at.d.rounded())) /
                        (at.w * cone.length_2.squared()).rounded();
  all.push_back({.at = std::move(at),
                 .curved = true,
                 .leaves = leaves,
                 .slack = slack,
                 .slack_of_root = slack_of_root,
                 .stretch = cone.stretch,
                 .radius = radius});
}

inline void add_crossings(const Cone& cone, const ExactRay& ray, std::vector<Crossing>& all) {
  const ConeEquation e(cone, ray.origin, ray.direction);
  const Number d = e.b.squared() - e.a * e.c;
  if (d.sign() < 0) return;
  const Number sign(e.a.sign());
  if (e.a.sign() == 0) {  // parallel to a line of the surface: one crossing at -c / 2b
    if (e.b.sign() == 0) return;
    const Number turn(e.b.sign());
    const Root at{-(turn * e.c), {}, d, Number(2.0) * e.b.abs()};
    return add_cone_crossing(cone, e, at, e.b.sign() > 0, all);
  }
  for (const bool leaves : {false, true}) {
    const Root at{-(sign * e.b), sign * Number(leaves ? 1.0 : -1.0), d, e.a.abs()};
    add_cone_crossing(cone, e, at, leaves, all);
  }
}

/// Returns all crossings of the line, whatever the interval, in ascending order.
inline std::vector<Crossing> crossings_of(const std::vector<Solid>& solids, const ExactRay& ray) {
  std::vector<Crossing> all;
  for (scenes::PrimitiveId id = 0; id < solids.size(); ++id) {
    const std::size_t first = all.size();
    std::visit([&](const auto& shape) { add_crossings(shape, ray, all); }, solids[id].shape);
    for (std::size_t i = first; i < all.size(); ++i) all[i].primitive = id;
  }
  std::ranges::stable_sort(
      all, [](const Crossing& a, const Crossing& b) { return compare(a.at, b.at) < 0; });
  return all;
}

}  // namespace beambench::exact

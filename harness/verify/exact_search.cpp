#include "harness/verify/exact_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>

#include <gmpxx.h>

#include "accel/core/tolerance.hpp"
#include "harness/verify/tolerance.hpp"

namespace beambench::verify {
namespace {

using Integer = mpz_class;

constexpr int kBits = 192;  // of quotients and roots, before they are rounded to double

/// Returns the float in units of the smallest positive float.
Integer whole(float number) { return Integer(std::ldexp(static_cast<double>(number), 149)); }

struct WholeVector {
  WholeVector(const glm::vec3& vector)
      : x(whole(vector.x)), y(whole(vector.y)), z(whole(vector.z)) {}
  WholeVector(Integer x_, Integer y_, Integer z_)
      : x(std::move(x_)), y(std::move(y_)), z(std::move(z_)) {}

  Integer x, y, z;
};

WholeVector operator-(const WholeVector& a, const WholeVector& b) {
  return {Integer(a.x - b.x), Integer(a.y - b.y), Integer(a.z - b.z)};
}
Integer dot(const WholeVector& a, const WholeVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
WholeVector cross(const WholeVector& a, const WholeVector& b) {
  return {Integer(a.y * b.z - a.z * b.y), Integer(a.z * b.x - a.x * b.z),
          Integer(a.x * b.y - a.y * b.x)};
}

/// Rounds to the nearest double: the first conversion only truncates.
double to_double(const mpf_class& number) {
  const double cut = number.get_d();
  return cut + mpf_class(number - cut, kBits).get_d();
}
double quotient(const mpf_class& dividend, const mpf_class& divisor) {
  return to_double(mpf_class(dividend / divisor, kBits));
}
mpf_class real(const Integer& integer) { return mpf_class(integer, kBits); }

/// Returns the sign of p + q sqrt(root), for a nonnegative root.
int sign_of_sum(const Integer& p, const Integer& q, const Integer& root) {
  const int sign_p = sgn(p);
  const int sign_q = sgn(q) * sgn(root);
  if (sign_p == sign_q || sign_q == 0) return sign_p;
  if (sign_p == 0) return sign_q;
  return sign_p * sgn(Integer(p * p - q * q * root));
}

/// A ray and the crossings found for one primitive.
class Finder {
 public:
  Finder(const accel::Ray& ray, scenes::PrimitiveId id)
      : origin_(ray.origin), direction_(ray.direction), id_(id) {}

  /// Applies Cramer's rule to origin + t d = a + v (b - a) + w (c - a).
  void add(const std::array<glm::vec3, 3>& corners) {
    const WholeVector a(corners[0]);
    const WholeVector ab = WholeVector(corners[1]) - a;
    const WholeVector ac = WholeVector(corners[2]) - a;
    const WholeVector from_a = origin_ - a;
    const WholeVector p = cross(direction_, ac);
    const Integer determinant = dot(ab, p);
    const int side = sgn(determinant);
    if (side == 0) return;
    const WholeVector q = cross(from_a, ab);
    const Integer v = dot(from_a, p);
    const Integer w = dot(direction_, q);
    if (side * sgn(v) < 0 || side * sgn(w) < 0) return;
    if (side * sgn(Integer(determinant - v - w)) < 0) return;
    add(quotient(real(dot(ac, q)), real(determinant)), false);
  }

  void add(const scenes::Sphere& sphere) {
    const WholeVector offset = origin_ - WholeVector(sphere.center);
    const Integer radius = whole(sphere.radius);
    add({dot(direction_, direction_), dot(offset, direction_),
         dot(offset, offset) - radius * radius},
        sphere.inside_only, [](int) { return true; });
  }

  /// Solves for the lateral surface. With m = x + t d from the base, H = m . axis and L = |axis|^2,
  /// the surface is L^2 |m|^2 - L H^2 = (radius L + taper H)^2 with 0 <= H <= L.
  void add(const scenes::Cone& cone) {
    const WholeVector axis = WholeVector(cone.apex) - WholeVector(cone.base);
    const WholeVector x = origin_ - WholeVector(cone.base);
    const Integer taper = whole(cone.apex_radius) - whole(cone.base_radius);
    const Integer length = dot(axis, axis);
    const Integer h0 = dot(x, axis);
    const Integer h1 = dot(direction_, axis);
    const Integer r0 = whole(cone.base_radius) * length + taper * h0;
    const Integer r1 = taper * h1;
    const Integer squared = length * length;
    const Quadratic quadratic{squared * dot(direction_, direction_) - length * h1 * h1 - r1 * r1,
                              squared * dot(x, direction_) - length * h0 * h1 - r0 * r1,
                              squared * dot(x, x) - length * h0 * h0 - r0 * r0};
    const Integer root = quadratic.discriminant();
    // Heights at the roots (-b +- sqrt(root)) / a, or at -c / 2b, times the divisor.
    add(quadratic, cone.inside_only, [&](int which) -> bool {
      const bool linear = sgn(quadratic.a) == 0;
      const Integer divisor = linear ? Integer(2 * quadratic.b) : quadratic.a;
      const Integer height = divisor * h0 - h1 * (linear ? quadratic.c : quadratic.b);
      const Integer by_root = linear ? Integer(0) : Integer(which * h1);
      const Integer below_apex = divisor * length - height;
      return sgn(divisor) * sign_of_sum(height, by_root, root) >= 0 &&
             sgn(divisor) * sign_of_sum(below_apex, Integer(-by_root), root) >= 0;
    });
  }

  std::vector<Crossing> take() && { return std::move(found_); }

 private:
  /// The polynomial a t^2 + 2 b t + c, negative inside.
  struct Quadratic {
    Integer a, b, c;

    Integer discriminant() const { return b * b - a * c; }
  };

  void add(double t, bool leaving) { found_.push_back({t, id_, leaving}); }

  /// The derivative at (-b + sqrt(discriminant)) / a is positive, so the ray leaves there.
  /// `is_part` receives the sign before the root.
  template <class IsPart>
  void add(const Quadratic& quadratic, bool inside_only, IsPart is_part) {
    const auto& [a, b, c] = quadratic;
    if (sgn(a) == 0) {
      const bool leaving = sgn(b) > 0;
      if (sgn(b) != 0 && (leaving || !inside_only) && is_part(0)) {
        add(quotient(-real(c), 2 * real(b)), leaving);
      }
      return;
    }
    const Integer discriminant = quadratic.discriminant();
    if (sgn(discriminant) < 0) return;
    const mpf_class root(sqrt(real(discriminant)), kBits);
    // The root of the larger magnitude, times a, without cancellation. The other is c over that.
    const int outer = sgn(b) < 0 ? 1 : -1;
    const mpf_class outer_root(outer * root - real(b), kBits);
    for (const int which : {-1, 1}) {
      const bool leaving = which > 0;
      if ((inside_only && !leaving) || !is_part(which)) continue;
      if (sgn(outer_root) == 0) {
        add(0.0, leaving);
      } else {
        add(which == outer ? quotient(outer_root, real(a)) : quotient(real(c), outer_root),
            leaving);
      }
    }
  }

  WholeVector origin_;
  WholeVector direction_;
  scenes::PrimitiveId id_;
  std::vector<Crossing> found_;
};

/// Returns whether the line reaches the box between two t.
bool reaches(const scenes::Bounds& box, double pad, const accel::Ray& ray, double enter,
             double leave) {
  for (int axis = 0; axis < 3; ++axis) {
    const double origin = ray.origin[axis];
    const double direction = ray.direction[axis];
    const double lower = box.lower[axis] - pad;
    const double upper = box.upper[axis] + pad;
    if (direction == 0.0) {
      if (origin < lower || origin > upper) return false;
      continue;
    }
    const auto [near, far] =
        std::minmax({(lower - origin) / direction, (upper - origin) / direction});
    enter = std::max(enter, near);
    leave = std::min(leave, far);
  }
  return enter <= leave;
}

}  // namespace

std::vector<scenes::PrimitiveId> primitives_near(const scenes::Scene& scene,
                                                 const accel::Ray& ray) {
  const glm::dvec3 origin(ray.origin);
  const double length = glm::length(glm::dvec3(ray.direction));
  std::vector<scenes::PrimitiveId> near;
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    const scenes::Bounds box = scenes::primitive_bounds(scene, id);
    // No point of the box has a larger tolerance.
    const double pad =
        2.0 * accel::kUnits * accel::float_unit(origin, glm::dvec3(box.largest_coordinate()));
    const double beyond = kAlong * pad / length;
    if (reaches(box, pad, ray, ray.t_min - beyond, ray.t_max + beyond)) near.push_back(id);
  }
  return near;
}

std::vector<Crossing> line_crossings(const scenes::Scene& scene, const accel::Ray& ray,
                                     scenes::PrimitiveId id) {
  Finder finder(ray, id);
  const scenes::Primitive& primitive = scene.primitives[id];
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      finder.add(scene.spheres[primitive.index]);
      break;
    case scenes::PrimitiveKind::kCone:
      finder.add(scene.cones[primitive.index]);
      break;
    case scenes::PrimitiveKind::kPolygon: {
      const scenes::Polygon& polygon = scene.polygons[primitive.index];
      for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
        const auto& vertex = scene.triangles[polygon.first_triangle + i].vertex;
        finder.add(
            {scene.vertices[vertex[0]], scene.vertices[vertex[1]], scene.vertices[vertex[2]]});
      }
      break;
    }
  }
  return std::move(finder).take();
}

std::vector<Crossing> crossings(const scenes::Scene& scene, const accel::Ray& ray,
                                const std::vector<scenes::PrimitiveId>& ids) {
  std::vector<Crossing> found;
  for (const scenes::PrimitiveId id : ids) {
    for (const Crossing& crossing : line_crossings(scene, ray, id)) {
      if (accel::in_interval(ray, crossing.t)) found.push_back(crossing);
    }
  }
  std::ranges::sort(found, {}, [](const Crossing& each) {
    return std::tuple(each.t, each.primitive, each.leaving);
  });
  return found;
}

}  // namespace beambench::verify

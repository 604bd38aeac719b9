#include "accel/oracle/exact_tests.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace beambench::accel::oracle {

using glm::dvec3;

namespace {

#ifdef __SIZEOF_FLOAT128__
__extension__ using Wide = __float128;
#else
using Wide = long double;  // 113 bits on some 64-bit processors
#endif

/// Returns `side` with all digits: differences of floats have about 26 bits, their products 52, and
/// products of these with the direction 77.
double wide_side(const ExactRay& ray, const dvec3& from, const dvec3& to) {
  const auto minor = [&](int i, int j) {
    const auto edge = [&](int k) { return Wide(to[k]) - Wide(from[k]); };
    const auto sum = [&](int k) { return Wide(from[k]) + Wide(to[k]); };
    return edge(i) * sum(j) - sum(i) * edge(j);
  };
  return static_cast<double>(minor(1, 2) * Wide(ray.direction.x) +
                             minor(2, 0) * Wide(ray.direction.y) +
                             minor(0, 1) * Wide(ray.direction.z));
}

/// Returns the side of the ray on which an edge passes, as the product of their Plücker
/// coordinates. Reversing the edge changes the sign of the edge vector but not of the sum, so the
/// two triangles of a shared edge get exactly opposite numbers, and no ray passes between them. The
/// sign is exact, so a ray through a vertex never has all edges at the vertex on one side, where it
/// would pass between all triangles.
double side(const ExactRay& ray, const dvec3& from, const dvec3& to) {
  const dvec3 edge = to - from;
  const dvec3 sum = from + to;
  const double value = glm::dot(glm::cross(edge, sum), ray.direction);
  // The error of each of the three terms, with its rounded parts, is below 6 x 2^-53 of `size`.
  const dvec3 e = glm::abs(edge);
  const dvec3 s = glm::abs(sum);
  const double size =
      glm::dot(dvec3(e.y * s.z + s.y * e.z, e.z * s.x + s.z * e.x, e.x * s.y + s.x * e.y),
               glm::abs(ray.direction));
  return std::abs(value) > 0x1p-50 * size ? value : wide_side(ray, from, to);
}

}  // namespace

std::optional<double> first_hit(const ExactRay& ray, const scenes::Scene& scene,
                                const scenes::Triangle& triangle) {
  const dvec3 a = dvec3(scene.vertices[triangle.vertex[0]]) - ray.origin;
  const dvec3 b = dvec3(scene.vertices[triangle.vertex[1]]) - ray.origin;
  const dvec3 c = dvec3(scene.vertices[triangle.vertex[2]]) - ray.origin;
  // The sides are the hit's barycentric weights, as yet without a common scale.
  const double at_c = side(ray, a, b);
  const double at_a = side(ray, b, c);
  const double at_b = side(ray, c, a);
  const auto [least, greatest] = std::minmax({at_a, at_b, at_c});
  if (least < 0.0 && greatest > 0.0) return std::nullopt;
  const double sum = at_a + at_b + at_c;
  if (sum == 0.0) return std::nullopt;  // seen edge-on: no area

  // A mean of the corners stays on the triangle even when it is seen nearly edge-on.
  const dvec3 hit = (at_a / sum) * a + (at_b / sum) * b + (at_c / sum) * c;
  const double t = glm::dot(hit, ray.direction) / glm::dot(ray.direction, ray.direction);
  return ray.contains(t) ? std::optional(t) : std::nullopt;
}

namespace {

/// The t at which a ray passes through a quadric a t^2 + 2 b t + c that is negative inside. The ray
/// enters where the derivative is negative and leaves where it is positive. A t is infinite if the
/// ray does not enter or does not leave.
struct Crossings {
  double enter = kInfinity;
  double leave = kInfinity;
};

/// Computes both roots without cancellation. Returns nothing for a ray that misses; both roots are
/// equal for a tangent ray.
std::optional<Crossings> crossings(double a, double b, double c) {
  if (a == 0.0) {
    if (b == 0.0) return std::nullopt;
    const double t = -0.5 * c / b;
    return b > 0.0 ? Crossings{kInfinity, t} : Crossings{t, kInfinity};
  }
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return std::nullopt;
  const double root = std::sqrt(discriminant);
  if (b < 0.0) return Crossings{c / (root - b), (root - b) / a};
  if (b + root == 0.0) return Crossings{0.0, 0.0};
  return Crossings{-(b + root) / a, -c / (b + root)};
}

/// Returns the t of the ray's point closest to `point`. Equations are set up relative to that point
/// of the ray, because digits would cancel for a distant eye.
double closest_approach(const ExactRay& ray, const dvec3& point) {
  return glm::dot(point - ray.origin, ray.direction) / glm::dot(ray.direction, ray.direction);
}

}  // namespace

std::optional<double> first_hit(const ExactRay& ray, const scenes::Sphere& sphere) {
  const dvec3 center(sphere.center);
  const double shift = closest_approach(ray, center);
  const dvec3 start = (ray.origin - center) + shift * ray.direction;
  const double distance = glm::length(start);
  const double radius = sphere.radius;
  const auto found =
      crossings(glm::dot(ray.direction, ray.direction), glm::dot(start, ray.direction),
                (distance - radius) * (distance + radius));
  if (!found) return std::nullopt;
  const double enter = shift + found->enter;
  const double leave = shift + found->leave;
  if (!sphere.inside_only && ray.contains(enter)) return enter;
  return ray.contains(leave) ? std::optional(leave) : std::nullopt;
}

namespace {

/// A cone's own frame: the middle of its axis at the origin, the apex on the z axis, and heights
/// stretched until the surface is nowhere flatter than 45 degrees. Otherwise the height of a flat
/// cone would be lost in rounding.
struct ConeFrame {
  explicit ConeFrame(const scenes::Cone& cone)
      : middle(0.5 * (dvec3(cone.base) + dvec3(cone.apex))),
        radius(0.5 * (static_cast<double>(cone.base_radius) + cone.apex_radius)) {
    const dvec3 axis = dvec3(cone.apex) - dvec3(cone.base);
    const double height = glm::length(axis);
    const double taper = static_cast<double>(cone.apex_radius) - cone.base_radius;
    const double stretched = std::max(height, std::abs(taper));
    half_height = 0.5 * stretched;
    slope = taper / stretched;
    const dvec3 unit = axis / height;
    const dvec3 size = glm::abs(unit);
    const dvec3 other = size.x <= size.y && size.x <= size.z ? dvec3(1.0, 0.0, 0.0)
                        : size.y <= size.z                   ? dvec3(0.0, 1.0, 0.0)
                                                             : dvec3(0.0, 0.0, 1.0);
    x = glm::normalize(glm::cross(other, unit));
    y = glm::cross(unit, x);
    z = stretched / height * unit;
  }

  dvec3 to_local(const dvec3& vector) const {
    return {glm::dot(vector, x), glm::dot(vector, y), glm::dot(vector, z)};
  }

  dvec3 middle, x, y, z;
  double radius;       ///< radius halfway up
  double half_height;  ///< half the stretched height
  double slope;        ///< change of the radius per unit of stretched height, from -1 to 1
};

}  // namespace

std::optional<double> first_hit(const ExactRay& ray, const scenes::Cone& cone) {
  const ConeFrame frame(cone);
  const dvec3 origin = frame.to_local(ray.origin - frame.middle);
  const dvec3 d = frame.to_local(ray.direction);
  // t counts from the ray's point closest to the middle in this frame, which is d x (origin x d) /
  // |d|^2: in this form, its height does not cancel.
  const double square = glm::dot(d, d);
  const double shift = -glm::dot(origin, d) / square;
  const dvec3 o = glm::cross(d, glm::cross(origin, d)) / square;

  // The quadric is x^2 + y^2 - r(z)^2, with the radius r(z) = r + slope z along the ray.
  const double r = frame.radius + frame.slope * o.z;
  const double r_grows = frame.slope * d.z;
  const double b = o.x * d.x + o.y * d.y - r * r_grows;
  const auto found =
      crossings(d.x * d.x + d.y * d.y - r_grows * r_grows, b, o.x * o.x + o.y * o.y - r * r);
  if (!found) return std::nullopt;
  if (cone.inside_only && found->enter == found->leave) return std::nullopt;  // tangent

  // Between base and apex the radius is not negative. This excludes the mirrored half of the double
  // cone. It also excludes infinite and undefined roots, for which the comparisons are false.
  std::optional<double> nearest;
  const auto consider = [&](double t) {
    const double height = o.z + t * d.z;
    if (!(std::abs(height) <= frame.half_height) || !ray.contains(shift + t)) return;
    if (!nearest || shift + t < *nearest) nearest = shift + t;
  };
  if (!cone.inside_only) consider(found->enter);
  consider(found->leave);
  return nearest;
}

ExactBounds bounds_of(const scenes::Scene& scene, const scenes::Triangle& triangle) {
  const dvec3 a(scene.vertices[triangle.vertex[0]]);
  const dvec3 b(scene.vertices[triangle.vertex[1]]);
  const dvec3 c(scene.vertices[triangle.vertex[2]]);
  return {glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c)};
}

ExactBounds bounds_of(const scenes::Sphere& sphere) {
  const dvec3 center(sphere.center);
  const double radius = sphere.radius;
  return {center - radius, center + radius};
}

ExactBounds bounds_of(const scenes::Cone& cone) {
  const ExactBounds base = bounds_of(scenes::Sphere{cone.base, cone.base_radius, false});
  const ExactBounds apex = bounds_of(scenes::Sphere{cone.apex, cone.apex_radius, false});
  return {glm::min(base.lower, apex.lower), glm::max(base.upper, apex.upper)};
}

}  // namespace beambench::accel::oracle

#include <cmath>

#include <glm/geometric.hpp>

#include "harness/verify/verify_ray.hpp"

namespace beambench::verify {
namespace {

using Real = long double;
using Vector = glm::vec<3, Real>;

/// Tests one ray against primitives and calls `offer_(id, t)` where its line meets them, in
/// whatever interval: primitives in ascending order, t in any order, NaN where nothing is met.
template <class Offer>
class Search {
 public:
  Search(const scenes::Scene& scene, const accel::Ray& ray, Offer offer)
      : scene_(scene),
        origin_(ray.origin),
        direction_(ray.direction),
        length_2_(glm::dot(direction_, direction_)),
        offer_(offer) {}

  void run() {
    for (scenes::PrimitiveId id = 0; id < scene_.primitives.size(); ++id) {
      const scenes::Primitive& primitive = scene_.primitives[id];
      switch (primitive.kind) {
        case scenes::PrimitiveKind::kSphere:
          test(id, scene_.spheres[primitive.index]);
          break;
        case scenes::PrimitiveKind::kCone:
          test(id, scene_.cones[primitive.index]);
          break;
        case scenes::PrimitiveKind::kPolygon:
          test(id, scene_.polygons[primitive.index]);
          break;
      }
    }
  }

 private:
  void test(scenes::PrimitiveId id, const scenes::Sphere& sphere) {
    const Vector offset = origin_ - Vector(sphere.center);
    const Real b = glm::dot(offset, direction_);
    const Real off_line = glm::dot(glm::cross(offset, direction_), glm::cross(offset, direction_));
    const Real radius = sphere.radius;
    // (b^2 - a c) = a r^2 - |offset x d|^2, by Lagrange's identity.
    const Real discriminant = length_2_ * radius * radius - off_line;
    if (discriminant < 0.0L) return;
    const Real root = std::sqrt(discriminant);
    if (!sphere.inside_only) offer_(id, (-b - root) / length_2_);
    offer_(id, (-b + root) / length_2_);
  }

  void test(scenes::PrimitiveId id, const scenes::Polygon& polygon) {
    for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
      test(id, scene_.triangles[polygon.first_triangle + i]);
    }
  }

  void test(scenes::PrimitiveId id, const scenes::Triangle& triangle) {
    const Vector a(scene_.vertices[triangle.vertex[0]]);
    const Vector b(scene_.vertices[triangle.vertex[1]]);
    const Vector c(scene_.vertices[triangle.vertex[2]]);
    // Cramer's rule for origin + t d = a + v (b - a) + w (c - a).
    const Vector ab = b - a;
    const Vector ac = c - a;
    const Vector from_a = origin_ - a;
    const Vector p = glm::cross(direction_, ac);
    const Real determinant = glm::dot(ab, p);
    if (determinant == 0.0L) return;
    const Real v = glm::dot(from_a, p) / determinant;
    if (!(0.0L <= v && v <= 1.0L)) return;
    const Vector q = glm::cross(from_a, ab);
    const Real w = glm::dot(direction_, q) / determinant;
    if (!(0.0L <= w && v + w <= 1.0L)) return;
    offer_(id, glm::dot(ac, q) / determinant);
  }

  void test(scenes::PrimitiveId id, const scenes::Cone& cone) {
    // Along the ray, s is the position on the axis (0 base, 1 apex), y the part of the point across
    // the axis and r the radius there: s = s0 + t s1, y = y0 + t y1, r = r0 + t r1; hits have
    // |y| = r. Where |y1| = |r1| the ray is parallel to a line of the surface.
    const Vector axis = Vector(cone.apex) - Vector(cone.base);
    const Real length_2 = glm::dot(axis, axis);
    const Vector x = origin_ - Vector(cone.base);
    const Real k = static_cast<Real>(cone.apex_radius) - cone.base_radius;
    const Real s0 = glm::dot(x, axis) / length_2;
    const Real s1 = glm::dot(direction_, axis) / length_2;
    const Vector y0 = x - s0 * axis;
    const Vector y1 = direction_ - s1 * axis;
    const Real r0 = cone.base_radius + k * s0;
    const Real r1 = k * s1;

    const Real a = glm::dot(y1, y1) - r1 * r1;
    const Real b = glm::dot(y0, y1) - r0 * r1;
    const Real c = glm::dot(y0, y0) - r0 * r0;
    // b^2 - a c = |r0 y1 - r1 y0|^2 - |y0 x y1|^2, by Lagrange's identity. On a flat cone r0 and r1
    // are huge and their products cancel, but not in s0 y1 - s1 y0 = axis x (d x x) / |axis|^2.
    const Vector moment = glm::cross(direction_, x);
    const Vector turned =
        static_cast<Real>(cone.base_radius) * y1 + k * (glm::cross(axis, moment) / length_2);
    const Real twist = glm::dot(moment, axis);
    const Real discriminant = glm::dot(turned, turned) - twist * twist / length_2;
    if (discriminant < 0.0L) return;
    const Real root = std::sqrt(discriminant);
    // A ray much steeper than the surface meets it at nearly one height, which its radius gives
    // best.
    const bool steep = r1 * r1 > 2.0L * glm::dot(y1, y1);
    const auto consider = [&](Real t, Real signed_root) {
      const Real s = steep ? ((glm::dot(y1, turned) + r1 * signed_root) / a - cone.base_radius) / k
                           : s0 + t * s1;
      const bool leaves = signed_root > 0.0L;
      if (0.0L <= s && s <= 1.0L && (leaves || !cone.inside_only)) offer_(id, t);
    };
    // The roots are (-b - root) / a and (-b + root) / a, written so that nothing cancels.
    const Real outer = b < 0.0L ? root : -root;
    consider((outer - b) / a, outer);
    consider(c / (outer - b), -outer);
  }

  const scenes::Scene& scene_;
  Vector origin_;
  Vector direction_;
  Real length_2_;
  Offer offer_;
};

}  // namespace

std::optional<accel::embree::ExactHit> exact_closest_hit(const scenes::Scene& scene,
                                                         const accel::Ray& ray) {
  scenes::PrimitiveId best = scenes::kNoPrimitive;
  Real best_t = ray.t_max;
  // Ids come in ascending order, so of equal hits the first stays. NaN is never in range.
  Search(scene, ray, [&](scenes::PrimitiveId id, Real t) {
    if (!(ray.t_min <= t) || !(best == scenes::kNoPrimitive ? t <= best_t : t < best_t)) return;
    best_t = t;
    best = id;
  }).run();
  if (best == scenes::kNoPrimitive) return std::nullopt;
  return accel::embree::ExactHit{static_cast<double>(best_t), best};
}

std::vector<accel::embree::ExactHit> exact_hits(const scenes::Scene& scene, const accel::Ray& ray) {
  std::vector<accel::embree::ExactHit> hits;
  Search(scene, ray, [&](scenes::PrimitiveId id, Real t) {
    if (ray.t_min <= t && t <= ray.t_max) hits.push_back({static_cast<double>(t), id});
  }).run();
  return hits;
}

}  // namespace beambench::verify

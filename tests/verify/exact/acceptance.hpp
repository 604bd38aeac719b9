#pragma once
// Decides exactly which claims about a ray are acceptable: the specification of the judge.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "accel/core/ray.hpp"
#include "tests/verify/exact/boundary.hpp"

namespace beambench::exact {

/// The allowed error of a claim: `factor` times K u, where u = 2^-24 (largest
/// |coordinate| of the point + distance of the ray's origin) and K = 16.
struct Leniency {
  double factor;
  Doubt doubt;
};

// Lengths are rounded from exact values; the margins exceed the resulting errors.
inline constexpr Leniency kStrict{0.25 * (1.0 - 0x1p-10), Doubt::kOpposes};
inline constexpr Leniency kGenerous{4.0 * (1.0 + 0x1p-10), Doubt::kFavors};

/// A ray over a scene with all crossings of its line.
struct Traced {
  Traced(const std::vector<Solid>& solids, const accel::Ray& ray)
      : solids(solids), ray(ray), crossings(crossings_of(solids, this->ray)) {
    for (const Crossing& crossing : crossings) inside.push_back(this->ray.contains(crossing.at));
  }

  const std::vector<Solid>& solids;
  ExactRay ray;
  std::vector<Crossing> crossings;  ///< of the line, in ascending order
  std::vector<bool> inside;         ///< for each crossing, whether it is in the interval
};

inline double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

/// Decides claims about one traced ray under one leniency.
class Acceptance {
 public:
  Acceptance(const Traced& traced, Leniency leniency) : traced_(traced), leniency_(leniency) {}

  /// Returns whether the claim of a closest hit, or of none, is acceptable.
  bool accepts(const std::optional<accel::Hit>& claim) const {
    if (!claim) return all_graze();
    const accel::Ray& ray = traced_.ray.given;
    if (claim->primitive >= traced_.solids.size() || !std::isfinite(claim->t) ||
        claim->t < ray.t_min || claim->t > ray.t_max) {
      return false;
    }
    return is_near(*claim) && nothing_is_lost_before(*claim);
  }

  /// Returns whether the result of an any-hit query is acceptable.
  bool accepts_occlusion(bool occluded) const {
    if (!occluded) return all_graze();
    if (std::ranges::find(traced_.inside, true) != traced_.inside.end()) return true;
    if (std::ranges::any_of(traced_.crossings,
                            [&](const Crossing& crossing) { return touches_an_end(crossing); })) {
      return true;
    }
    return std::ranges::any_of(traced_.solids,
                               [&](const Solid& solid) { return is_grazed(solid); });
  }

  /// Returns whether missing the crossing is also acceptable.
  bool is_graze(const Crossing& crossing) const {
    return touches_an_end(crossing) ||
           is_near_boundary(solid_of(crossing), traced_.ray, within(crossing), leniency_.doubt);
  }

 private:
  bool favors() const { return leniency_.doubt == Doubt::kFavors; }
  const Solid& solid_of(const Crossing& crossing) const {
    return traced_.solids[crossing.primitive];
  }

  /// Returns e(x) for the solid. The guard for double arithmetic always favors the claim.
  double within_at(const Solid& solid, double largest_coordinate) const {
    const glm::dvec3 origin(traced_.ray.given.origin);
    const double u = 0x1p-24 * (largest_coordinate + glm::length(origin));
    const double e = leniency_.factor * 16.0 * u;
    if (!favors()) return e;
    const double farthest =
        glm::length(glm::max(glm::abs(solid.lower - origin), glm::abs(solid.upper - origin)));
    return std::max({e, 0x1p-50 * farthest, 0x1p-126});
  }
  double within(const Solid& solid, double parameter) const {
    return within_at(solid, largest(glm::abs(traced_.ray.at(parameter))));
  }
  double within(const Crossing& crossing) const {
    return within(solid_of(crossing), crossing.at.rounded());
  }

  /// Returns `Crossing::is_across`. Within e of a cone's apex, any cosine is possible.
  bool is_across(const Crossing& crossing, const Number& s, double e) const {
    if (crossing.radius > e) return crossing.is_across(s, e);
    return favors() || crossing.is_along(s, e / traced_.ray.speed);
  }

  /// Returns whether the parameter and the crossing are at the same point, measured across the
  /// crossing's surface.
  bool is_one_place(const Crossing& crossing, const Number& s) const {
    const double there = within(crossing);
    const double here = within(solid_of(crossing), s.rounded());
    const double e = favors() ? std::max(there, here) : std::min(there, here);
    return is_across(crossing, s, e) && crossing.is_along(s, 1024.0 * e / traced_.ray.speed);
  }

  bool touches_an_end(const Crossing& crossing) const {
    const accel::Ray& ray = traced_.ray.given;
    return is_one_place(crossing, traced_.ray.parameter(ray.t_min)) ||
           (std::isfinite(ray.t_max) && is_one_place(crossing, traced_.ray.parameter(ray.t_max)));
  }

  bool all_graze() const {
    for (std::size_t i = 0; i < traced_.crossings.size(); ++i) {
      if (traced_.inside[i] && !is_graze(traced_.crossings[i])) return false;
    }
    return true;
  }

  /// Returns whether the claim is at this crossing of its own primitive.
  bool is_same(const Crossing& crossing, const accel::Hit& claim, const Number& s) const {
    if (crossing.primitive != claim.primitive) return false;
    const double there = within(crossing);
    const double here = within(solid_of(crossing), s.rounded());
    if (!is_across(crossing, s, favors() ? std::max(there, here) : std::min(there, here))) {
      return false;
    }
    return favors() || !crossing.curved || leaves(solid_of(crossing), s) == crossing.leaves;
  }

  /// Returns whether the ray at the parameter moves away from a sphere's center or a cone's axis.
  bool leaves(const Solid& solid, const Number& s) const {
    if (const auto* sphere = std::get_if<Sphere>(&solid.shape)) {
      return dot(traced_.ray.at(s) - sphere->center, traced_.ray.direction).sign() > 0;
    }
    const ConeEquation e(std::get<Cone>(solid.shape), traced_.ray.origin, traced_.ray.direction);
    return (e.a * s + e.b).sign() > 0;
  }

  /// Visits the crossings before the claim. Among crossings at one parameter, the claim's own comes
  /// first if doubts favor the claim, and last otherwise.
  bool nothing_is_lost_before(const accel::Hit& claim) const {
    const Number s = traced_.ray.parameter(claim.t);
    const std::vector<Crossing>& all = traced_.crossings;
    for (std::size_t first = 0, last = 0; first < all.size(); first = last) {
      bool found = false;
      bool lost = false;
      for (last = first; last < all.size(); ++last) {
        if (last > first && compare(all[last].at, all[first].at) != 0) break;
        if (!traced_.inside[last]) continue;
        if (is_same(all[last], claim, s)) {
          found = true;
        } else if (compare(all[last].at, s) >= 0) {
          found = true;  // nothing before the claim remains
        } else if (!is_one_place(all[last], s) && !is_graze(all[last])) {
          lost = true;
        }
      }
      if (found && (favors() || !lost)) return true;
      if (lost) return false;
    }
    return true;
  }

  bool is_near(const accel::Hit& claim) const {
    const Solid& solid = traced_.solids[claim.primitive];
    const Number s = traced_.ray.parameter(claim.t);
    const double e = within(solid, s.rounded());
    const Vector x = traced_.ray.at(s);
    if (favors()) {
      const glm::dvec3 point = x.rounded();
      const glm::dvec3 beyond = glm::max(solid.lower - point, point - solid.upper);
      if (largest(beyond) > 1025.0 * e) return false;
    }
    return std::visit([&](const auto& shape) { return is_near(shape, claim, s, x, e); },
                      solid.shape);
  }

  bool is_near(const Polygon& polygon, const accel::Hit& claim, const Number& s, const Vector& x,
               double e) const {
    const Number e_2 = Number(e).squared();
    const auto crosses_here = [&] {
      return std::ranges::any_of(traced_.crossings, [&](const Crossing& crossing) {
        return crossing.primitive == claim.primitive && is_one_place(crossing, s);
      });
    };
    for (const Triangle& triangle : polygon.triangles) {
      const Vector offset = x - triangle.a;
      if (dot(triangle.normal, offset).squared() > e_2 * square(triangle.normal)) continue;
      if (favors()) {
        if (passes_through(triangle, traced_.ray) || is_near_edge(traced_.ray, triangle, e_2)) {
          return true;
        }
      } else if (is_over(triangle, x) ||
                 (passes_through(triangle, traced_.ray) && crosses_here())) {
        return true;
      }
    }
    return false;
  }

  /// Returns whether the point, moved perpendicularly into the plane, is in the triangle.
  static bool is_over(const Triangle& triangle, const Vector& x) {
    const auto is_inward = [&](const Vector& from, const Vector& to) {
      return dot(cross(to - from, x - from), triangle.normal).sign() >= 0;
    };
    return is_inward(triangle.a, triangle.b) && is_inward(triangle.b, triangle.c) &&
           is_inward(triangle.c, triangle.a);
  }

  bool is_near(const Sphere& sphere, const accel::Hit& /*claim*/, const Number& s, const Vector& x,
               double e) const {
    const Number distance_2 = square(x - sphere.center);
    const Number outer = sphere.radius + Number(e);
    const Number inner = sphere.radius - Number(e);
    if (distance_2 > outer.squared()) return false;
    if (inner.sign() > 0 && distance_2 < inner.squared()) return false;
    return is_visible_side({sphere, {}, {}}, sphere.inside_only, s, e);
  }

  bool is_near(const Cone& cone, const accel::Hit& claim, const Number& s, const Vector& x,
               double e) const {
    const Vector offset = x - cone.base;
    const Number height = dot(offset, cone.axis);
    // |across| is within e stretch of the radius at this height; all terms are times |axis|^2.
    const Number across_2 = (square(offset) * cone.length_2 - height.squared()) * cone.length_2;
    const Number signed_radius = cone.base_radius * cone.length_2 + cone.taper * height;
    const Number radius = favors() ? signed_radius.abs() : signed_radius;
    const Number widened = Number(e * cone.stretch) * cone.length_2;
    const Number outer = radius + widened;
    const Number inner = radius - widened;
    if (outer.sign() < 0 || across_2 > outer.squared()) return false;
    if (inner.sign() > 0 && across_2 < inner.squared()) return false;
    if (!favors() && !is_over(cone, height, across_2)) return false;
    const Solid& solid = traced_.solids[claim.primitive];
    if (favors() && crossing_counts(cone, traced_.ray) == std::array<int, 2>{} &&
        !is_near_boundary(solid, traced_.ray, e, leniency_.doubt)) {
      return false;
    }
    return is_visible_side(solid, cone.inside_only, s, e);
  }

  /// Returns whether a point, moved perpendicularly onto the surface continued beyond its rims, is
  /// between the rims: `height` and `across_2` as in `is_near`.
  static bool is_over(const Cone& cone, const Number& height, const Number& across_2) {
    // The place along the slanted line, measured from the base, is (across - base_radius) taper +
    // height; the apex is at taper^2 + |axis|^2. Both are multiplied by |axis|^2.
    const Number place = (height - cone.base_radius * cone.taper) * cone.length_2;
    const Number apex = (cone.taper.squared() + cone.length_2) * cone.length_2;
    return sign_with_root(place, cone.taper, across_2) >= 0 &&
           sign_with_root(place - apex, cone.taper, across_2) <= 0;
  }

  /// Returns whether the ray meets the visible side: a solid visible from the inside only is hit
  /// where the ray leaves it. Near its silhouette, entering and leaving cannot be distinguished.
  bool is_visible_side(const Solid& solid, bool inside_only, const Number& s, double e) const {
    return !inside_only || leaves(solid, s) ||
           (favors() && is_near_boundary(solid, traced_.ray, e, leniency_.doubt));
  }

  /// Returns whether the ray passes so close to the solid that a hit is also acceptable.
  bool is_grazed(const Solid& solid) const {
    const glm::dvec3 middle = 0.5 * (solid.lower + solid.upper);
    const double most = largest(glm::max(glm::abs(solid.lower), glm::abs(solid.upper)));
    const double least =
        std::max(0.0, largest(glm::abs(middle)) - glm::length(solid.upper - middle));
    const double e = within_at(solid, favors() ? most : least);
    return (favors() ? may_reach(solid, e) : reaches_all_of(solid)) &&
           is_near_boundary(solid, traced_.ray, e, leniency_.doubt);
  }

  bool may_reach(const Solid& solid, double e) const {
    const accel::Ray& ray = traced_.ray.given;
    for (int axis = 0; axis < 3; ++axis) {
      const double origin = ray.origin[axis];
      const double direction = ray.direction[axis];
      const double start = direction == 0.0 ? origin : origin + ray.t_min * direction;
      const double end = direction == 0.0 ? origin : origin + ray.t_max * direction;
      if (std::max(start, end) < solid.lower[axis] - 2.0 * e ||
          std::min(start, end) > solid.upper[axis] + 2.0 * e) {
        return false;
      }
    }
    return true;
  }

  bool reaches_all_of(const Solid& solid) const {
    const Number speed_2 = square(traced_.ray.direction);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 at((corner & 1) != 0 ? solid.upper.x : solid.lower.x,
                          (corner & 2) != 0 ? solid.upper.y : solid.lower.y,
                          (corner & 4) != 0 ? solid.upper.z : solid.lower.z);
      const Number along = dot(Vector(at) - traced_.ray.origin, traced_.ray.direction);
      if (along <= traced_.ray.from.at * speed_2 || along >= traced_.ray.to.at * speed_2) {
        return false;
      }
    }
    return true;
  }

  const Traced& traced_;
  Leniency leniency_;
};

}  // namespace beambench::exact

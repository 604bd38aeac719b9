#include "harness/verify/contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "harness/verify/tolerance.hpp"

namespace beambench::verify {
namespace {

/// A corner may be 10^9 away from where a ray passes its polygon: double would lose the significant
/// digits.
using Real = long double;
using Vector = glm::vec<3, Real>;

constexpr Real kFar = std::numeric_limits<Real>::infinity();

/// The smallest distance that the arithmetic of the tests in double can resolve, relative to the
/// distance to the farthest point of a primitive.
constexpr double kMinPart = 0x1p-50;

/// The line of a ray, with a direction of unit length.
struct RayLine {
  explicit RayLine(const accel::Ray& ray)
      : origin(ray.origin),
        length(glm::length(Vector(ray.direction))),
        direction(Vector(ray.direction) / length) {}

  /// Returns the vector from the line to the point, perpendicular to the line.
  Vector across(const Vector& point) const {
    const Vector offset = point - origin;
    return offset - glm::dot(offset, direction) * direction;
  }
  Real distance_to(const Vector& point) const { return glm::length(across(point)); }
  /// Returns the line's approach to a point.
  Approach approach(const Vector& point) const {
    return {static_cast<double>(glm::length(across(point))),
            static_cast<double>(glm::dot(point - origin, direction) / length)};
  }
  Approach approach_to_segment(const Vector& from, const Vector& to) const {
    const Vector a = across(from);
    const Vector edge = across(to) - a;
    const Real length_2 = glm::dot(edge, edge);
    const Real at = length_2 > 0.0L ? std::clamp(-glm::dot(a, edge) / length_2, 0.0L, 1.0L) : 0.0L;
    return {static_cast<double>(glm::length(a + at * edge)),
            static_cast<double>(glm::dot(from + at * (to - from) - origin, direction) / length)};
  }

  Vector origin;
  Real length;  ///< of the ray's direction
  Vector direction;
};

using Corners = std::array<Vector, 3>;

Corners corners_of(const scenes::Scene& scene, const scenes::Triangle& triangle) {
  return {Vector(scene.vertices[triangle.vertex[0]]), Vector(scene.vertices[triangle.vertex[1]]),
          Vector(scene.vertices[triangle.vertex[2]])};
}

std::array<Approach, 3> edge_approaches(const RayLine& line, const Corners& corners) {
  return {line.approach_to_segment(corners[0], corners[1]),
          line.approach_to_segment(corners[1], corners[2]),
          line.approach_to_segment(corners[2], corners[0])};
}

double least_distance(std::span<const Approach> approaches) {
  double least = static_cast<double>(kFar);
  for (const Approach& each : approaches) least = std::min(least, each.distance);
  return least;
}

/// Returns the distance at which the line passes beside the triangle; 0 if it passes through.
Real lateral_distance(const RayLine& line, const Corners& corners) {
  const Vector a = line.across(corners[0]);
  const Vector b = line.across(corners[1]);
  const Vector c = line.across(corners[2]);
  const auto [least, greatest] = std::minmax({glm::dot(glm::cross(a, b), line.direction),
                                              glm::dot(glm::cross(b, c), line.direction),
                                              glm::dot(glm::cross(c, a), line.direction)});
  // A line in the triangle's plane never passes between its edges.
  const Real none = 0x1p-58L * std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
  const bool is_in_plane = least >= -none && greatest <= none;
  if (!is_in_plane && (least >= 0.0L || greatest <= 0.0L)) return 0.0L;
  return least_distance(edge_approaches(line, corners));
}

Contact made(double tolerance, Real offset, Real cosine, bool leaving) {
  return {tolerance, static_cast<double>(offset), static_cast<double>(cosine), leaving};
}

/// Returns the contact with the triangle of a polygon that fits the claim best.
Contact contact_with(const scenes::Scene& scene, const RayLine& line, const Vector& point,
                     const scenes::Polygon& polygon, double tolerance) {
  Contact best{tolerance};
  for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
    const Corners corners = corners_of(scene, scene.triangles[polygon.first_triangle + i]);
    const Vector normal =
        glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    const Real off_plane = std::abs(glm::dot(normal, point - corners[0]));
    const Contact found = made(tolerance, std::max(off_plane, lateral_distance(line, corners)),
                               std::abs(glm::dot(normal, line.direction)), false);
    if (found.offset < best.offset) best = found;
  }
  return best;
}

Approach silhouette_approach(const RayLine& line, const scenes::Sphere& sphere) {
  const Vector center(sphere.center);
  return {static_cast<double>(std::abs(glm::length(line.across(center)) - Real{sphere.radius})),
          line.approach(center).t};
}

Contact contact_with(const RayLine& line, const Vector& point, const scenes::Sphere& sphere,
                     double tolerance) {
  const Vector from_center = point - Vector(sphere.center);
  const Real distance = glm::length(from_center);
  const Real along = glm::dot(from_center, line.direction);
  Contact found = made(tolerance, std::abs(distance - Real{sphere.radius}),
                       std::abs(along) / distance, along > 0.0L);
  if (sphere.inside_only && !found.leaving &&
      silhouette_approach(line, sphere).distance > tolerance) {
    found.offset = static_cast<double>(kFar);
  }
  return found;
}

/// A cone as a segment that is rotated about the axis, of unit direction (along_radius, along_axis)
/// in the half plane of (distance from the axis, height over the base). Cones with nearly zero
/// height need no special treatment, because nothing is divided by the height.
struct Profile {
  explicit Profile(const scenes::Cone& cone) : base(cone.base), base_radius(cone.base_radius) {
    const Vector span = Vector(cone.apex) - base;
    const Real height = glm::length(span);
    const Real taper = static_cast<Real>(cone.apex_radius) - cone.base_radius;
    axis = span / height;
    length = std::hypot(taper, height);
    along_radius = taper / length;
    along_axis = height / length;
  }

  Real height_of(const Vector& point) const { return glm::dot(point - base, axis); }
  /// Returns the vector from the axis to the point, perpendicular to the axis.
  Vector radial(const Vector& point) const { return point - base - height_of(point) * axis; }
  /// Returns the unit vector from the axis to the point; 0 for a point on the axis.
  Vector outward(const Vector& point) const {
    const Vector across = radial(point);
    const Real distance = glm::length(across);
    return distance > 0.0L ? across / distance : Vector(0.0L);
  }
  /// Returns the distance of a point from the surface continued beyond its rims; negative inside.
  Real signed_distance(const Vector& point) const {
    return (glm::length(radial(point)) - base_radius) * along_axis -
           height_of(point) * along_radius;
  }
  /// Returns the place on the surface, continued beyond its rims, nearest to the point: from 0 at
  /// the base to `length` at the apex.
  Real place(const Vector& point) const {
    return (glm::length(radial(point)) - base_radius) * along_radius +
           height_of(point) * along_axis;
  }
  /// Returns the point of the rim at a place of 0 or `length` on the same side of the axis as
  /// `point`.
  Vector rim_point(const Vector& point, Real rim) const {
    return base + rim * along_axis * axis + rim_radius(rim) * outward(point);
  }
  Real rim_radius(Real rim) const { return base_radius + rim * along_radius; }

  Vector base;
  Vector axis;
  Real base_radius, length, along_radius, along_axis;
};

/// A line seen from a cone's axis: at t from the line's point closest to the axis, its distance
/// from the axis is sqrt(speed^2 t^2 + gap^2), and its height grows with `climb`.
struct LineByAxis {
  LineByAxis(const RayLine& line, const Profile& profile) : direction(line.direction) {
    climb = glm::dot(direction, profile.axis);
    const Vector across = direction - climb * profile.axis;
    const Vector middle = profile.base + 0.5L * profile.length * profile.along_axis * profile.axis;
    speed = glm::length(across);
    start = middle - line.across(middle);
    if (speed > 0.0L)
      start -= glm::dot(profile.radial(start), across) / (speed * speed) * direction;
    gap = glm::length(profile.radial(start));
  }
  Vector at(Real t) const { return start + t * direction; }

  Vector start;
  Vector direction;
  Real climb, speed, gap;
};

/// Returns how close the line comes to touching the surface without crossing it, or to having its
/// entry and exit in one point. The signed distance of the line's points from the surface is convex
/// in t, so it has one turning point, or none if the line is steeper than the surface.
std::optional<Approach> silhouette_approach(const RayLine& line, const Profile& profile) {
  const LineByAxis seen(line, profile);
  const Real rise = seen.climb * profile.along_radius;
  const Real spread = seen.speed * profile.along_axis;
  const Real square = (spread - rise) * (spread + rise);
  if (!(square > 0.0L)) return std::nullopt;
  const Vector turning_point = seen.at(rise * seen.gap / (seen.speed * std::sqrt(square)));
  const Real place = profile.place(turning_point);
  if (!(0.0L <= place && place <= profile.length)) return std::nullopt;
  return Approach{static_cast<double>(std::abs(profile.signed_distance(turning_point))),
                  line.approach(turning_point).t};
}

/// Adds the line's approaches to a rim: from where it crosses the rim's plane, and from where it
/// passes over the rim or is closest to the axis. Each is improved by alternately finding the rim's
/// point nearest to the line and the line's point nearest to the rim. The distance is never too
/// small.
void add_rim_approaches(const RayLine& line, const Profile& profile, Real rim,
                        std::vector<Approach>& found) {
  constexpr int kTurns = 8;
  const LineByAxis seen(line, profile);
  const Real radius = profile.rim_radius(rim);
  const Real over_rim =
      std::sqrt(std::max((radius - seen.gap) * (radius + seen.gap), 0.0L)) / seen.speed;
  const Real in_plane = (rim * profile.along_axis - profile.height_of(seen.start)) / seen.climb;
  for (const Real t : {in_plane, -over_rim, 0.0L, over_rim}) {
    if (!std::isfinite(t)) continue;
    Vector point = seen.at(t);
    Approach nearest{static_cast<double>(kFar), 0.0};
    for (int turn = 0; turn < kTurns; ++turn) {
      const Vector on_rim = profile.rim_point(point, rim);
      const Approach approach = line.approach(on_rim);
      if (approach.distance < nearest.distance) nearest = approach;
      point = on_rim - line.across(on_rim);
    }
    found.push_back(nearest);
  }
}

std::vector<Approach> cone_approaches(const RayLine& line, const scenes::Cone& cone) {
  const Profile profile(cone);
  std::vector<Approach> found;
  if (const auto silhouette = silhouette_approach(line, profile)) found.push_back(*silhouette);
  add_rim_approaches(line, profile, 0.0L, found);
  add_rim_approaches(line, profile, profile.length, found);
  return found;
}

/// Returns the line's distance from a rim near `point`: its distance from the rim's point nearest
/// to `point`, or less if the line comes closer to the rim at one place with `point`.
Real rim_distance(const RayLine& line, const Profile& profile, const Vector& point, Real rim,
                  double tolerance) {
  Real nearest = line.distance_to(profile.rim_point(point, rim));
  std::vector<Approach> found;
  add_rim_approaches(line, profile, rim, found);
  const Real t = line.approach(point).t;
  for (const Approach& each : found) {
    if (std::abs(each.t - t) * line.length > kAlong * tolerance) continue;
    nearest = std::min<Real>(nearest, each.distance);
  }
  return nearest;
}

Contact contact_with(const RayLine& line, const Vector& point, const scenes::Cone& cone,
                     double tolerance) {
  const Profile profile(cone);
  const Real place = profile.place(point);
  const Real within = std::clamp(place, 0.0L, profile.length);
  Real offset = std::abs(profile.signed_distance(point));
  if (place != within) {
    offset = std::max(offset, rim_distance(line, profile, point, within, tolerance));
  }
  const Vector normal =
      profile.outward(point) * profile.along_axis - profile.along_radius * profile.axis;
  const Real outward = glm::dot(normal, line.direction);
  Contact found = made(tolerance, offset, std::abs(outward), outward > 0.0L);
  if (cone.inside_only && !found.leaving &&
      least_distance(cone_approaches(line, cone)) > tolerance) {
    found.offset = static_cast<double>(kFar);
  }
  return found;
}

double tolerance_in(const scenes::Bounds& box, const accel::Ray& ray, double t) {
  const glm::dvec3 origin(ray.origin);
  const glm::dvec3 reach =
      glm::max(glm::abs(glm::dvec3(box.lower) - origin), glm::abs(glm::dvec3(box.upper) - origin));
  return std::max(tolerance(ray, t), kMinPart * glm::length(reach));
}

}  // namespace

double tolerance(const scenes::Scene& scene, const accel::Ray& ray,
                 const accel::oracle::ExactHit& hit) {
  return tolerance_in(scenes::primitive_bounds(scene, hit.primitive), ray, hit.t);
}

Contact contact(const scenes::Scene& scene, const accel::Ray& ray,
                const accel::oracle::ExactHit& hit) {
  const scenes::Bounds box = scenes::primitive_bounds(scene, hit.primitive);
  const double near = tolerance_in(box, ray, hit.t);
  const Vector point = Vector(ray.origin) + Real{hit.t} * Vector(ray.direction);
  const Vector outside = glm::max(Vector(box.lower) - point, point - Vector(box.upper));
  if (std::max({outside.x, outside.y, outside.z}) > kAlong * near) return {near};
  const RayLine line(ray);
  const scenes::Primitive& primitive = scene.primitives[hit.primitive];
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      return contact_with(line, point, scene.spheres[primitive.index], near);
    case scenes::PrimitiveKind::kCone:
      return contact_with(line, point, scene.cones[primitive.index], near);
    case scenes::PrimitiveKind::kPolygon:
      break;
  }
  return contact_with(scene, line, point, scene.polygons[primitive.index], near);
}

std::vector<Approach> approaches(const scenes::Scene& scene, const accel::Ray& ray,
                                 scenes::PrimitiveId id) {
  const RayLine line(ray);
  const scenes::Primitive& primitive = scene.primitives[id];
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      return {silhouette_approach(line, scene.spheres[primitive.index])};
    case scenes::PrimitiveKind::kCone:
      return cone_approaches(line, scene.cones[primitive.index]);
    case scenes::PrimitiveKind::kPolygon:
      break;
  }
  const scenes::Polygon& polygon = scene.polygons[primitive.index];
  std::vector<Approach> found;
  for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
    const scenes::Triangle& triangle = scene.triangles[polygon.first_triangle + i];
    const auto edges = edge_approaches(line, corners_of(scene, triangle));
    found.insert(found.end(), edges.begin(), edges.end());
  }
  return found;
}

double boundary_distance(const scenes::Scene& scene, const accel::Ray& ray,
                         scenes::PrimitiveId id) {
  return least_distance(approaches(scene, ray, id));
}

}  // namespace beambench::verify

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>

#include <glm/geometric.hpp>

#include "harness/verify/verify_ray.hpp"

namespace beambench::verify {
namespace {

using glm::dvec3;

constexpr double kFar = std::numeric_limits<double>::infinity();

/// The line of a ray, in double and with a direction of unit length.
struct RayLine {
  explicit RayLine(const accel::Ray& ray)
      : origin(ray.origin), direction(glm::normalize(dvec3(ray.direction))) {}

  /// From the line to the point, perpendicular to the line.
  dvec3 across(const dvec3& point) const {
    const dvec3 offset = point - origin;
    return offset - glm::dot(offset, direction) * direction;
  }
  double distance_to(const dvec3& point) const { return glm::length(across(point)); }
  double distance_to_segment(const dvec3& from, const dvec3& to) const {
    const dvec3 a = across(from);
    const dvec3 edge = across(to) - a;
    const double length_2 = glm::dot(edge, edge);
    const double at = length_2 > 0.0 ? std::clamp(-glm::dot(a, edge) / length_2, 0.0, 1.0) : 0.0;
    return glm::length(a + at * edge);
  }

  dvec3 origin;
  dvec3 direction;
};

using Corners = std::array<dvec3, 3>;

Corners corners_of(const scenes::Scene& scene, const scenes::Triangle& triangle) {
  return {dvec3(scene.vertices[triangle.vertex[0]]), dvec3(scene.vertices[triangle.vertex[1]]),
          dvec3(scene.vertices[triangle.vertex[2]])};
}

double edge_distance(const RayLine& line, const Corners& corners) {
  return std::min({line.distance_to_segment(corners[0], corners[1]),
                   line.distance_to_segment(corners[1], corners[2]),
                   line.distance_to_segment(corners[2], corners[0])});
}

/// By how much the line passes beside the triangle; 0 through it.
double lateral_distance(const RayLine& line, const Corners& corners) {
  const dvec3 a = line.across(corners[0]);
  const dvec3 b = line.across(corners[1]);
  const dvec3 c = line.across(corners[2]);
  const auto [least, greatest] = std::minmax({glm::dot(glm::cross(a, b), line.direction),
                                              glm::dot(glm::cross(b, c), line.direction),
                                              glm::dot(glm::cross(c, a), line.direction)});
  if (least >= 0.0 || greatest <= 0.0) return 0.0;
  return edge_distance(line, corners);
}

Contact contact_with(const RayLine& line, const dvec3& point, const Corners& corners) {
  const dvec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  const double off_plane = std::abs(glm::dot(normal, point - corners[0]));
  return {std::max(off_plane, lateral_distance(line, corners)),
          std::abs(glm::dot(normal, line.direction)), false};
}

/// Of a polygon, the triangle that the claim fits best.
Contact contact_with(const scenes::Scene& scene, const RayLine& line, const dvec3& point,
                     const scenes::Polygon& polygon) {
  Contact best{kFar, 0.0, false};
  for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
    const scenes::Triangle& triangle = scene.triangles[polygon.first_triangle + i];
    const Contact found = contact_with(line, point, corners_of(scene, triangle));
    if (found.offset < best.offset) best = found;
  }
  return best;
}

double silhouette_distance(const RayLine& line, const scenes::Sphere& sphere) {
  return std::abs(glm::length(line.across(dvec3(sphere.center))) - sphere.radius);
}

Contact contact_with(const RayLine& line, const dvec3& point, const scenes::Sphere& sphere,
                     double grazing) {
  const dvec3 from_center = point - dvec3(sphere.center);
  const double distance = glm::length(from_center);
  const double along = glm::dot(from_center, line.direction);
  Contact found{std::abs(distance - sphere.radius), std::abs(along) / distance, along > 0.0};
  if (sphere.inside_only && !found.leaving && silhouette_distance(line, sphere) > grazing) {
    found.offset = kFar;
  }
  return found;
}

/// A cone as a segment that is turned round the axis, of unit direction (along_radius, along_axis)
/// in the half plane of (distance from the axis, height over the base). Cones of hardly any height
/// are nothing special so: nothing is divided by the height.
struct Profile {
  explicit Profile(const scenes::Cone& cone) : base(cone.base), base_radius(cone.base_radius) {
    const dvec3 span = dvec3(cone.apex) - base;
    const double height = glm::length(span);
    const double taper = static_cast<double>(cone.apex_radius) - cone.base_radius;
    axis = span / height;
    length = std::hypot(taper, height);
    along_radius = taper / length;
    along_axis = height / length;
  }

  double height_of(const dvec3& point) const { return glm::dot(point - base, axis); }
  /// From the axis to the point, perpendicular to the axis.
  dvec3 radial(const dvec3& point) const { return point - base - height_of(point) * axis; }
  /// The unit vector from the axis to the point; 0 for a point on the axis.
  dvec3 outward(const dvec3& point) const {
    const dvec3 across = radial(point);
    const double distance = glm::length(across);
    return distance > 0.0 ? across / distance : dvec3(0.0);
  }
  /// Distance of a point from the surface continued beyond its rims; negative inside.
  double signed_distance(const dvec3& point) const {
    return (glm::length(radial(point)) - base_radius) * along_axis -
           height_of(point) * along_radius;
  }
  /// Where on the surface, continued beyond its rims, the point is nearest: from 0 at the base to
  /// `length` at the apex.
  double place(const dvec3& point) const {
    return (glm::length(radial(point)) - base_radius) * along_radius +
           height_of(point) * along_axis;
  }
  /// The rim at a place of 0 or `length`: its point on the same side of the axis as `point`.
  dvec3 rim_point(const dvec3& point, double rim) const {
    return base + rim * along_axis * axis + rim_radius(rim) * outward(point);
  }
  double rim_radius(double rim) const { return base_radius + rim * along_radius; }

  dvec3 base;
  dvec3 axis;
  double base_radius, length, along_radius, along_axis;
};

/// A line seen from a cone's axis: at t from the line's point closest to the axis, its distance
/// from the axis is sqrt(speed^2 t^2 + gap^2), and its height grows with `climb`.
struct LineByAxis {
  LineByAxis(const RayLine& line, const Profile& profile) : direction(line.direction) {
    climb = glm::dot(direction, profile.axis);
    const dvec3 across = direction - climb * profile.axis;
    const dvec3 middle = profile.base + 0.5 * profile.length * profile.along_axis * profile.axis;
    speed = glm::length(across);
    start = middle - line.across(middle);
    if (speed > 0.0) start -= glm::dot(profile.radial(start), across) / (speed * speed) * direction;
    gap = glm::length(profile.radial(start));
  }
  dvec3 at(double t) const { return start + t * direction; }

  dvec3 start;
  dvec3 direction;
  double climb, speed, gap;
};

/// How near the line comes to touching the surface without crossing it, or to having its entry and
/// exit in one point. The signed distance of the line's points from the surface is convex in t, so
/// it turns once, or never where the line is steeper than the surface.
double silhouette_distance(const RayLine& line, const Profile& profile) {
  const LineByAxis seen(line, profile);
  const double rise = seen.climb * profile.along_radius;
  const double spread = seen.speed * profile.along_axis;
  const double square = (spread - rise) * (spread + rise);
  if (!(square > 0.0)) return kFar;
  const dvec3 turning_point = seen.at(rise * seen.gap / (seen.speed * std::sqrt(square)));
  const double place = profile.place(turning_point);
  if (!(0.0 <= place && place <= profile.length)) return kFar;
  return std::abs(profile.signed_distance(turning_point));
}

/// The distance from the line to a rim: from where it crosses the rim's plane, and from where it
/// passes over the rim or is closest to the axis, each improved by looking for the rim's point next
/// to the line and the line's next to that in turn. Never too small.
double rim_distance(const RayLine& line, const Profile& profile, double rim) {
  constexpr int kTurns = 8;
  const LineByAxis seen(line, profile);
  const double radius = profile.rim_radius(rim);
  const double over_rim =
      std::sqrt(std::max((radius - seen.gap) * (radius + seen.gap), 0.0)) / seen.speed;
  const double in_plane = (rim * profile.along_axis - profile.height_of(seen.start)) / seen.climb;
  double nearest = kFar;
  for (const double t : {in_plane, -over_rim, 0.0, over_rim}) {
    if (!std::isfinite(t)) continue;
    dvec3 point = seen.at(t);
    for (int turn = 0; turn < kTurns; ++turn) {
      const dvec3 on_rim = profile.rim_point(point, rim);
      const dvec3 across = line.across(on_rim);
      nearest = std::min(nearest, glm::length(across));
      point = on_rim - across;
    }
  }
  return nearest;
}

double cone_boundary_distance(const RayLine& line, const scenes::Cone& cone) {
  const Profile profile(cone);
  return std::min({silhouette_distance(line, profile), rim_distance(line, profile, 0.0),
                   rim_distance(line, profile, profile.length)});
}

Contact cone_contact(const RayLine& line, const dvec3& point, const scenes::Cone& cone,
                     double grazing) {
  const Profile profile(cone);
  const double place = profile.place(point);
  const double within = std::clamp(place, 0.0, profile.length);
  double offset = std::abs(profile.signed_distance(point));
  if (place != within) {
    offset = std::max(offset, line.distance_to(profile.rim_point(point, within)));
  }
  const dvec3 normal =
      profile.outward(point) * profile.along_axis - profile.along_radius * profile.axis;
  const double outward = glm::dot(normal, line.direction);
  Contact found{offset, std::abs(outward), outward > 0.0};
  if (cone.inside_only && !found.leaving && cone_boundary_distance(line, cone) > grazing) {
    found.offset = kFar;
  }
  return found;
}

}  // namespace

Contact contact(const scenes::Scene& scene, const accel::Ray& ray,
                const accel::embree::ExactHit& hit, double grazing) {
  const RayLine line(ray);
  const dvec3 point = dvec3(ray.origin) + hit.t * dvec3(ray.direction);
  const scenes::Primitive& primitive = scene.primitives[hit.primitive];
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      return contact_with(line, point, scene.spheres[primitive.index], grazing);
    case scenes::PrimitiveKind::kCone:
      return cone_contact(line, point, scene.cones[primitive.index], grazing);
    case scenes::PrimitiveKind::kPolygon:
      return contact_with(scene, line, point, scene.polygons[primitive.index]);
  }
  return {kFar, 0.0, false};
}

double boundary_distance(const scenes::Scene& scene, const accel::Ray& ray,
                         scenes::PrimitiveId id) {
  const RayLine line(ray);
  const scenes::Primitive& primitive = scene.primitives[id];
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      return silhouette_distance(line, scene.spheres[primitive.index]);
    case scenes::PrimitiveKind::kCone:
      return cone_boundary_distance(line, scene.cones[primitive.index]);
    case scenes::PrimitiveKind::kPolygon:
      break;
  }
  const scenes::Polygon& polygon = scene.polygons[primitive.index];
  double nearest = kFar;
  for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
    const scenes::Triangle& triangle = scene.triangles[polygon.first_triangle + i];
    nearest = std::min(nearest, edge_distance(line, corners_of(scene, triangle)));
  }
  return nearest;
}

}  // namespace beambench::verify

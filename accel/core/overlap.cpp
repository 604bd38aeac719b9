#include "accel/core/overlap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace beambench::accel {

bool surface_overlaps(const scenes::Scene& scene, scenes::PrimitiveId id, const Box& box,
                      double tolerance) {
  const scenes::Primitive& primitive = scene.primitives[id];
  switch (primitive.kind) {
    case scenes::PrimitiveKind::kSphere:
      return sphere_overlaps(scene.spheres[primitive.index], box, tolerance);
    case scenes::PrimitiveKind::kCone:
      return cone_overlaps(scene.cones[primitive.index], box, tolerance);
    case scenes::PrimitiveKind::kPolygon:
      return polygon_overlaps(scene, scene.polygons[primitive.index], box, tolerance);
  }
  return true;
}

namespace {

bool same_triangles(const scenes::Scene& scene, const scenes::Polygon& a,
                    const scenes::Polygon& b) {
  if (a.triangle_count != b.triangle_count) return false;
  for (std::uint32_t i = 0; i < a.triangle_count; ++i) {
    const auto& of_a = scene.triangles[a.first_triangle + i].vertex;
    const auto& of_b = scene.triangles[b.first_triangle + i].vertex;
    for (std::size_t k = 0; k < 3; ++k) {
      if (scene.vertices[of_a[k]] != scene.vertices[of_b[k]]) return false;
    }
  }
  return true;
}

}  // namespace

bool same_surface(const scenes::Scene& scene, scenes::PrimitiveId a, scenes::PrimitiveId b) {
  const scenes::Primitive& one = scene.primitives[a];
  const scenes::Primitive& other = scene.primitives[b];
  if (one.kind != other.kind) return false;
  switch (one.kind) {
    case scenes::PrimitiveKind::kSphere: {
      const scenes::Sphere& s = scene.spheres[one.index];
      const scenes::Sphere& t = scene.spheres[other.index];
      return s.center == t.center && s.radius == t.radius;
    }
    case scenes::PrimitiveKind::kCone: {
      const scenes::Cone& c = scene.cones[one.index];
      const scenes::Cone& d = scene.cones[other.index];
      return c.base == d.base && c.apex == d.apex && c.base_radius == d.base_radius &&
             c.apex_radius == d.apex_radius;
    }
    case scenes::PrimitiveKind::kPolygon:
      return same_triangles(scene, scene.polygons[one.index], scene.polygons[other.index]);
  }
  return false;
}

bool sphere_overlaps(const scenes::Sphere& sphere, const Box& box, double tolerance) {
  double nearest = 0.0;   // squared distance from the center to the box
  double farthest = 0.0;  // squared distance to the box's farthest corner
  for (int axis = 0; axis < 3; ++axis) {
    const double below = box.lower[axis] - sphere.center[axis];
    const double above = sphere.center[axis] - box.upper[axis];
    const double outside = std::max({below, above, 0.0});
    const double across = std::max(-below, -above);
    nearest += outside * outside;
    farthest += across * across;
  }
  const double outer = sphere.radius + tolerance;
  const double inner = std::max(sphere.radius - tolerance, 0.0);
  return nearest <= outer * outer && farthest >= inner * inner;
}

namespace {

/// Returns the half sizes of a disc's box: r sqrt(1 - axis_i^2) for the unit axis.
glm::dvec3 disc_extent(const glm::dvec3& unit_axis, double radius) {
  return radius * glm::sqrt(glm::max(glm::dvec3(1.0) - unit_axis * unit_axis, glm::dvec3(0.0)));
}

bool boxes_meet(const Box& a, const Box& b, double tolerance) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a.lower[axis] > b.upper[axis] + tolerance || b.lower[axis] > a.upper[axis] + tolerance) {
      return false;
    }
  }
  return true;
}

}  // namespace

bool cone_overlaps(const scenes::Cone& cone, const Box& box, double tolerance) {
  const glm::dvec3 base(cone.base);
  const glm::dvec3 apex(cone.apex);
  const glm::dvec3 axis = apex - base;
  const double length = glm::length(axis);
  const glm::dvec3 unit_axis = axis / length;
  const glm::dvec3 base_extent = disc_extent(unit_axis, cone.base_radius);
  const glm::dvec3 apex_extent = disc_extent(unit_axis, cone.apex_radius);
  const Box discs{glm::min(base - base_extent, apex - apex_extent),
                  glm::max(base + base_extent, apex + apex_extent)};
  if (!boxes_meet(discs, box, tolerance)) return false;

  // No overlap if the box is far from the axis.
  const glm::dvec3 center = (box.lower + box.upper) * 0.5;
  const double half_diagonal = 0.5 * glm::length(box.upper - box.lower);
  const double along = std::clamp(glm::dot(center - base, unit_axis), 0.0, length);
  const double from_axis = glm::length(center - (base + unit_axis * along));
  const double largest_radius = std::max(cone.base_radius, cone.apex_radius);
  if (from_axis > half_diagonal + largest_radius + tolerance) return false;

  // No overlap if the box is beyond one end or wholly inside the solid, which is convex.
  bool all_below = true;
  bool all_above = true;
  bool all_inside = true;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 point((corner & 1) != 0 ? box.upper.x : box.lower.x,
                           (corner & 2) != 0 ? box.upper.y : box.lower.y,
                           (corner & 4) != 0 ? box.upper.z : box.lower.z);
    const double height = glm::dot(point - base, unit_axis);
    const double distance = glm::length(point - (base + unit_axis * height));
    const double taper = (static_cast<double>(cone.apex_radius) - cone.base_radius) / length;
    const double radius = cone.base_radius + height * taper;
    // The distance to a slanted surface is less than the distance within the disc, so widen the
    // tolerance by the slope.
    const double margin = tolerance * (1.0 + std::abs(taper));
    all_below = all_below && height < -tolerance;
    all_above = all_above && height > length + tolerance;
    all_inside = all_inside && distance < radius - margin;
  }
  return !(all_below || all_above || all_inside);
}

namespace {

/// The rounding error of the axis tests relative to their products, with an ample margin.
constexpr double kRounding = 0x1p-48;

/// Returns one bit for each of the box's 6 face, 12 edge and 8 corner planes that the point is
/// outside of. `p` is relative to the center of the box; the edge planes are |x| + |y| = h_x + h_y
/// and so on, the corner planes |x| + |y| + |z| = h_x + h_y + h_z.
std::uint32_t outcode(const glm::dvec3& p, const glm::dvec3& half) {
  std::uint32_t code = 0;
  std::uint32_t bit = 1;
  const auto outside = [&](double distance, double limit) {
    if (distance > limit) code |= bit;
    bit <<= 1U;
  };
  for (int axis = 0; axis < 3; ++axis) {
    outside(p[axis], half[axis]);
    outside(-p[axis], half[axis]);
  }
  for (int first = 0; first < 3; ++first) {
    const int second = (first + 1) % 3;
    const double limit = half[first] + half[second];
    outside(p[first] + p[second], limit);
    outside(p[first] - p[second], limit);
    outside(-p[first] + p[second], limit);
    outside(-p[first] - p[second], limit);
  }
  const double limit = half.x + half.y + half.z;
  for (int corner = 0; corner < 8; ++corner) {
    outside(((corner & 1) != 0 ? p.x : -p.x) + ((corner & 2) != 0 ? p.y : -p.y) +
                ((corner & 4) != 0 ? p.z : -p.z),
            limit);
  }
  return code;
}

/// Returns whether the projections on `axis` of the triangle `v` and of the centered box `half` are
/// disjoint.
bool separated(const glm::dvec3& axis, const std::array<glm::dvec3, 3>& v, const glm::dvec3& half,
               double slack) {
  const double p0 = glm::dot(axis, v[0]);
  const double p1 = glm::dot(axis, v[1]);
  const double p2 = glm::dot(axis, v[2]);
  const double radius = glm::dot(glm::abs(axis), half) + slack;
  return std::min({p0, p1, p2}) > radius || std::max({p0, p1, p2}) < -radius;
}

bool centered_triangle_overlaps(const std::array<glm::dvec3, 3>& v, const glm::dvec3& half) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::min({v[0][axis], v[1][axis], v[2][axis]}) > half[axis] ||
        std::max({v[0][axis], v[1][axis], v[2][axis]}) < -half[axis]) {
      return false;
    }
  }
  const std::array<glm::dvec3, 3> edges{v[1] - v[0], v[2] - v[1], v[0] - v[2]};
  const glm::dvec3 largest = glm::max(glm::max(glm::abs(v[0]), glm::abs(v[1])), glm::abs(v[2]));
  const double reach = largest.x + largest.y + largest.z;
  const double edge_reach = 2.0 * reach;
  const double slack = kRounding * reach * edge_reach;
  if (separated(glm::cross(edges[0], edges[1]), v, half, slack * edge_reach)) return false;
  for (const glm::dvec3& e : edges) {
    if (separated({0.0, -e.z, e.y}, v, half, slack) ||
        separated({e.z, 0.0, -e.x}, v, half, slack) ||
        separated({-e.y, e.x, 0.0}, v, half, slack)) {
      return false;
    }
  }
  return true;
}

}  // namespace

bool triangle_overlaps(const std::array<glm::dvec3, 3>& corners, const Box& box, double tolerance) {
  const glm::dvec3 center = (box.lower + box.upper) * 0.5;
  const glm::dvec3 half = (box.upper - box.lower) * 0.5 + glm::dvec3(tolerance);
  const std::array<glm::dvec3, 3> v{corners[0] - center, corners[1] - center, corners[2] - center};
  return centered_triangle_overlaps(v, half);
}

bool polygon_overlaps(const scenes::Scene& scene, const scenes::Polygon& polygon, const Box& box,
                      double tolerance) {
  const glm::dvec3 center = (box.lower + box.upper) * 0.5;
  const glm::dvec3 half = (box.upper - box.lower) * 0.5 + glm::dvec3(tolerance);
  if (polygon.triangle_count > 1) {
    std::uint32_t outside_all = ~0U;
    for (std::uint32_t i = 0; i < polygon.corner_count && outside_all != 0; ++i) {
      const glm::vec3& corner = scene.vertices[scene.corners[polygon.first_corner + i]];
      outside_all &= outcode(glm::dvec3(corner) - center, half);
    }
    if (outside_all != 0) return false;
  }
  for (std::uint32_t i = 0; i < polygon.triangle_count; ++i) {
    const auto& vertex = scene.triangles[polygon.first_triangle + i].vertex;
    const std::array<glm::dvec3, 3> v{glm::dvec3(scene.vertices[vertex[0]]) - center,
                                      glm::dvec3(scene.vertices[vertex[1]]) - center,
                                      glm::dvec3(scene.vertices[vertex[2]]) - center};
    if (centered_triangle_overlaps(v, half)) return true;
  }
  return false;
}

}  // namespace beambench::accel

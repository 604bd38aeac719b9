#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "accel/core/overlap.hpp"

namespace beambench::accel {

namespace {

/// Rounding of the axis tests relative to the products they are made of, amply.
constexpr double kRounding = 0x1p-48;

/// One bit for each of the box's 6 face, 12 edge and 8 corner planes that the point is outside of.
/// `p` is relative to the center of the box; the edge planes are |x| + |y| = h_x + h_y and so on,
/// the corner planes |x| + |y| + |z| = h_x + h_y + h_z.
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

/// Do the projections on `axis` of the triangle `v` and of the centered box `half` lie apart?
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

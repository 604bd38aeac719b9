#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "accel/core/overlap.hpp"

namespace beambench::accel {

namespace {

/// The half sizes of a disc's box: r sqrt(1 - axis_i^2) for the unit axis.
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

  // Far from the axis?
  const glm::dvec3 center = (box.lower + box.upper) * 0.5;
  const double half_diagonal = 0.5 * glm::length(box.upper - box.lower);
  const double along = std::clamp(glm::dot(center - base, unit_axis), 0.0, length);
  const double from_axis = glm::length(center - (base + unit_axis * along));
  const double largest_radius = std::max(cone.base_radius, cone.apex_radius);
  if (from_axis > half_diagonal + largest_radius + tolerance) return false;

  // Beyond one end, or wholly inside the solid (which is convex)?
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
    // The distance to a slanted surface is less than that within the disc; widen by the slope.
    const double margin = tolerance * (1.0 + std::abs(taper));
    all_below = all_below && height < -tolerance;
    all_above = all_above && height > length + tolerance;
    all_inside = all_inside && distance < radius - margin;
  }
  return !(all_below || all_above || all_inside);
}

}  // namespace beambench::accel

#pragma once
// The surface area heuristic's expected costs of the planes that may divide a cell.

#include <cstdint>

#include <glm/vec3.hpp>

#include "accel/bvh/primitive_block.hpp"
#include "accel/kd_tree/kd_tree_options.hpp"
#include "scenes/bounds.hpp"

namespace beambench::accel::kd_tree {

/// The costs of planes across one axis of a cell (MacDonald and Booth, "Heuristics for ray tracing
/// using space subdivision", 1990).
class PlaneCost {
 public:
  PlaneCost(const scenes::Bounds& cell, int axis, const KdTreeOptions& options)
      : lower_(cell.lower[axis]),
        upper_(cell.upper[axis]),
        traversal_(options.traversal_cost),
        discount_(1.0 - options.empty_bonus) {
    const glm::dvec3 size = glm::dvec3(cell.upper) - glm::dvec3(cell.lower);
    const double side = size[(axis + 1) % 3];
    const double other = size[(axis + 2) % 3];
    const double area = size[axis] * (side + other) + side * other;
    ends_ = options.intersection_cost * (side * other) / area;
    along_ = options.intersection_cost * (side + other) / area;
  }

  /// Returns whether the plane cuts the cell in two.
  bool is_inside(float plane) const { return lower_ < plane && plane < upper_; }
  /// Returns the cost of a leaf with `items` items for rays that meet it.
  static double leaf(std::uint32_t items, const KdTreeOptions& options) {
    return options.intersection_cost * blocks(items);
  }
  /// Returns the cost for a ray that meets the cell if `below` and `above` items extend to the
  /// respective sides of the plane.
  double operator()(float plane, std::uint32_t below, std::uint32_t above) const {
    const double cost = traversal_ + blocks(below) * (ends_ + (double{plane} - lower_) * along_) +
                        blocks(above) * (ends_ + (upper_ - double{plane}) * along_);
    return below == 0 || above == 0 ? cost * discount_ : cost;
  }

 private:
  /// Returns the number of blocks in which items are tested. If costs ignored blocks, a tree would
  /// have twice the nodes, and rays would take longer.
  static std::uint32_t blocks(std::uint32_t items) {
    constexpr std::uint32_t kLanes = bvh::kBvhLanes;
    return (items + kLanes - 1) / kLanes;
  }

  double lower_;
  double upper_;
  double traversal_;
  double discount_;
  double ends_;   ///< probability of meeting a face across the axis, times the cost of a block
  double along_;  ///< increase of this product for each unit of length
};

}  // namespace beambench::accel::kd_tree

#pragma once
// A node that a top-down builder has yet to make.

#include <cstddef>
#include <cstdint>

#include "accel/bvh/bvh_builder.hpp"

namespace beambench::accel::bvh {

/// A node to be made of the items [begin, end). Its descendants are numbered from `free` on, where
/// there is space for the maximum, so that the number of a node does not depend on the task that
/// builds it.
struct PendingNode {
  std::size_t node;
  std::size_t free;
  std::size_t begin;
  std::size_t end;
  std::uint32_t depth;

  std::size_t count() const { return end - begin; }
  /// Returns the child with the items before `middle`.
  PendingNode left(std::size_t middle) const { return {free, free + 2, begin, middle, depth + 1}; }
  PendingNode right(std::size_t middle) const {
    const std::size_t left_nodes = 2 * (middle - begin) - 2;  // at most, below the left child
    return {free + 1, free + 2 + left_nodes, middle, end, depth + 1};
  }

  void make_leaf(BvhNode& made) const {
    made.first = static_cast<std::uint32_t>(begin);
    made.count = static_cast<std::uint32_t>(count());
  }
  void make_interior(BvhNode& made) const {
    made.first = static_cast<std::uint32_t>(free);
    made.count = 0;
  }
};

}  // namespace beambench::accel::bvh

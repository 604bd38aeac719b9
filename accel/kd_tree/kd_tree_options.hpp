#pragma once
// Options of a kd-tree.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "scenes/base/parameters.hpp"

namespace beambench::accel::kd_tree {

/// The maximum number of splits on the path from the root to a leaf; a traversal's stack has this
/// many entries.
inline constexpr int kMaxSplits = 64;

struct KdTreeOptions {
  enum class Builder { kSah, kMedian };

  Builder builder = Builder::kSah;
  double traversal_cost = 1.0;     ///< cost of passing an interior node
  double intersection_cost = 0.4;  ///< cost of testing a block of up to eight primitives
  double empty_bonus = 0.2;        ///< fraction by which cutting off empty space is cheaper
  std::optional<int> max_depth;    ///< splits above a leaf; empty: see `depth_for`
  std::uint32_t max_objects = 1;   ///< nodes with more primitives may be split
  bool clip = true;                ///< assign the part of a primitive in a cell, not its whole box
  std::optional<std::uint64_t> max_references;  ///< empty: see `references_for`

  static std::vector<ParameterInfo> parameters();
  static KdTreeOptions from(const Parameters& parameters);

  /// Returns `max_depth` or its default: for the heuristic, 8 + 1.3 log2(n) (Pharr and Humphreys,
  /// "Physically Based Rendering", 2004; the form is Havran's); for the spatial median, 15, which
  /// results in the cells of the thesis's octree of level 6.
  int depth_for(std::size_t primitives) const;
  /// Returns `max_references` or its default: 10 million, or 8 per primitive if that is more.
  /// Meshes have fewer than two references per triangle.
  std::uint64_t references_for(std::size_t primitives) const;
};

}  // namespace beambench::accel::kd_tree

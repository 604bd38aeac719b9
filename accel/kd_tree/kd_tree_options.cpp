#include "accel/kd_tree/kd_tree_options.hpp"

#include <algorithm>
#include <cmath>

namespace beambench::accel::kd_tree {

std::vector<ParameterInfo> KdTreeOptions::parameters() {
  const KdTreeOptions defaults;
  ParameterInfo depth = integer_or_auto_parameter(
      "max_depth", 0, 0, kMaxSplits,
      "maximum number of splits from the root to a leaf; auto: 8 + 1.3 log2 of the number of "
      "primitives, or 15 with builder=median (the cells of an octree of level 6)");
  depth.default_value = "auto";
  ParameterInfo references = integer_or_auto_parameter(
      "max_references", 1, 1, 2'000'000'000,
      "stop with an error beyond this many references (up to 384 bytes each); auto: 10 million, or "
      "8 per primitive if that is more");
  references.default_value = "auto";
  return {
      choice_parameter("builder", "sah", {"sah", "median"},
                       "where a node is split: where the surface area heuristic expects the "
                       "least work, if that is less than a leaf's; or in the middle of each "
                       "axis in turn (Kaplan 1985), down to max_objects or max_depth"),
      real_parameter("traversal_cost", defaults.traversal_cost, 0.001, 1000.0,
                     "builder=sah: the cost of passing an interior node"),
      real_parameter("intersection_cost", defaults.intersection_cost, 0.001, 1000.0,
                     "builder=sah: the cost of testing a block of up to eight primitives by SIMD"),
      real_parameter("empty_bonus", defaults.empty_bonus, 0.0, 1.0,
                     "builder=sah: the fraction by which the cost of a split is reduced if one "
                     "side is empty"),
      depth,
      integer_parameter("max_objects", defaults.max_objects, 0, 1'000'000,
                        "a node with more primitives than this is split (polygons count as "
                        "triangles); builder=sah: only if that is expected to pay"),
      flag_parameter("clip", defaults.clip,
                     "assign a primitive to children by its part inside the cell (Wald and "
                     "Havran 2006), not by its whole box"),
      references};
}

KdTreeOptions KdTreeOptions::from(const Parameters& parameters) {
  KdTreeOptions options;
  options.builder = parameters.choice("builder") == "sah" ? Builder::kSah : Builder::kMedian;
  options.traversal_cost = parameters.real("traversal_cost");
  options.intersection_cost = parameters.real("intersection_cost");
  options.empty_bonus = parameters.real("empty_bonus");
  if (const auto depth = parameters.integer_or_auto("max_depth")) {
    options.max_depth = static_cast<int>(*depth);
  }
  options.max_objects = static_cast<std::uint32_t>(parameters.integer("max_objects"));
  options.clip = parameters.flag("clip");
  if (const auto references = parameters.integer_or_auto("max_references")) {
    options.max_references = static_cast<std::uint64_t>(*references);
  }
  return options;
}

int KdTreeOptions::depth_for(std::size_t primitives) const {
  if (max_depth) return *max_depth;
  if (builder == Builder::kMedian) return 15;
  const double doublings = std::log2(static_cast<double>(std::max<std::size_t>(primitives, 1)));
  return std::min(kMaxSplits, static_cast<int>(8.0 + 1.3 * doublings));
}

std::uint64_t KdTreeOptions::references_for(std::size_t primitives) const {
  return max_references.value_or(
      std::max(std::uint64_t{10'000'000}, std::uint64_t{8} * primitives));
}

}  // namespace beambench::accel::kd_tree

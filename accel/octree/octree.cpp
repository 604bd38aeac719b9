#include "accel/octree/octree.hpp"

#include "accel/core/expected_visits.hpp"
#include "accel/octree/box_cursor.hpp"
#include "accel/octree/for_each_node.hpp"
#include "accel/octree/octree_cursor.hpp"
#include "scenes/base/error.hpp"

namespace beambench::accel::octree {

namespace {

constexpr int kDeepestLevel = 16;

}  // namespace

std::vector<ParameterInfo> OctreeOptions::parameters() {
  const OctreeOptions defaults;
  return {
      integer_or_auto_parameter(
          "max_level", defaults.max_level, 1, kDeepestLevel,
          "deepest level of the octree, the root being level 1 as in the thesis: 2^(max_level-1) "
          "cells per axis; auto: the level that is expected to be the fastest for the rays to "
          "come"),
      integer_parameter("max_objects", defaults.max_objects, 0, 1'000'000,
                        "a node with more primitives than this is split"),
      choice_parameter("root", "cube", {"cube", "box"},
                       "the root cell: the cube around the scene (thesis) or the scene's own box"),
      choice_parameter("assign", "surface", {"surface", "bbox"},
                       "the part of a primitive that must overlap a cell that refers to it: its "
                       "surface, or only its bounding box"),
      real_parameter("pad", defaults.pad, 0.0, 1.0,
                     "margin added to each side of the root cell, as a fraction of its size"),
      integer_parameter("max_references", static_cast<std::int64_t>(defaults.max_references), 1,
                        2'000'000'000,
                        "stop with an error beyond this many references (4 bytes each)")};
}

OctreeOptions OctreeOptions::from(const Parameters& parameters) {
  OctreeOptions options;
  options.max_level =
      static_cast<int>(parameters.integer_or_auto("max_level").value_or(kAutomatic));
  options.max_objects = static_cast<std::uint32_t>(parameters.integer("max_objects"));
  options.root = parameters.choice("root") == "cube" ? Root::kCube : Root::kBox;
  options.assign = parameters.choice("assign") == "surface" ? Assign::kSurface : Assign::kBounds;
  options.pad = parameters.real("pad");
  options.max_references = static_cast<std::uint64_t>(parameters.integer("max_references"));
  return options;
}

std::vector<ParameterInfo> OctreeOptions::top_down_parameters() {
  const OctreeOptions defaults;
  std::vector<ParameterInfo> all = parameters();
  all.push_back(choice_parameter(
      "planes", "median", {"median", "cost"},
      "where a node is divided: in its middle, or on each axis at the cheapest of 10 positions "
      "between the spatial and the object median (cost of MacDonald and Booth)"));
  all.push_back(choice_parameter(
      "build", "complete", {"complete", "on-demand", "hashed"},
      "when nodes are divided and how they are found: all before the first ray; those below "
      "built_level when the first ray enters them; or all before the first ray, but found by "
      "name in a hash table instead of by links, as in a linear octree; neither hits nor "
      "counters change"));
  all.push_back(integer_parameter("built_level", defaults.built_level, 1, kDeepestLevel,
                                  "with build=on-demand, levels divided before the first ray"));
  return all;
}

OctreeOptions OctreeOptions::from_top_down(const Parameters& parameters) {
  OctreeOptions options = from(parameters);
  options.planes = parameters.choice("planes") == "cost" ? Planes::kCost : Planes::kMedian;
  const std::string& build = parameters.choice("build");
  options.build = build == "complete"    ? Build::kComplete
                  : build == "on-demand" ? Build::kOnDemand
                                         : Build::kHashed;
  options.built_level = static_cast<int>(parameters.integer("built_level"));
  return options;
}

std::vector<ParameterInfo> OctreeOptions::root_search_parameters() {
  std::vector<ParameterInfo> all = top_down_parameters();
  all.push_back(choice_parameter(
      "exits", "explicit", {"explicit", "iterative"},
      "how the exit of a leaf is found: from its planes, or by stepping over the octree's "
      "finest cells; only with planes=median"));
  return all;
}

OctreeOptions OctreeOptions::from_root_search(const Parameters& parameters) {
  OctreeOptions options = from_top_down(parameters);
  options.exits = parameters.choice("exits") == "iterative" ? Exits::kIterative : Exits::kExplicit;
  if (options.exits == Exits::kIterative && options.planes == Planes::kCost) {
    throw InputError(
        "exits=iterative steps over the octree's finest cells, of which planes=cost has 65,536 "
        "along each axis; give planes=median with it, or choose exits=explicit");
  }
  return options;
}

Statistics Octree::statistics() const {
  Statistics statistics;
  statistics.nodes = nodes_.size();
  for (const OctreeNode& node : nodes_) {
    if (!node.is_leaf()) continue;
    ++statistics.leaves;
    if (node.count == 0) ++statistics.empty_leaves;
  }
  statistics.references = reference_count();
  statistics.depth = static_cast<std::uint64_t>(deepest_level_);
  statistics.bytes = sizeof(*this) + nodes_.capacity() * sizeof(OctreeNode) +
                     references_.capacity() * sizeof(scenes::PrimitiveId) +
                     splits_.capacity() * sizeof(splits_[0]);
  ExpectedVisits visits(scene_bounds_);
  const auto add = [&](const auto& place) {
    const Box cell = grid_.box(place.corner(), place.size());
    place.is_leaf() ? visits.add_leaf(cell, place.node().count) : visits.add_node(cell);
  };
  central_planes_ ? for_each_node(OctreeCursor(*this), add) : for_each_node(BoxCursor(*this), add);
  visits.append_to(statistics);
  return statistics;
}

std::vector<Cell> Octree::occupied_cells() const {
  std::vector<Cell> cells;
  const auto add = [&](const auto& place) {
    if (!place.is_leaf() || place.node().count == 0) return;
    cells.push_back({grid_.box(place.corner(), place.size()), place.level()});
  };
  central_planes_ ? for_each_node(OctreeCursor(*this), add) : for_each_node(BoxCursor(*this), add);
  return cells;
}

}  // namespace beambench::accel::octree

#pragma once
// The octree of the thesis (section 3.3), shared by every structure that traverses one.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/cell_grid.hpp"
#include "accel/core/statistics.hpp"
#include "scenes/base/parameters.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::octree {

/// How an octree is subdivided.
struct OctreeOptions {
  enum class Root { kCube, kBox };          ///< a cube around the scene (thesis), or its own box
  enum class Assign { kSurface, kBounds };  ///< a reference where the surface, or its box, reaches

  enum class Planes { kMedian, kCost };       ///< nodes halved, or planes where a cost is least
  enum class Build { kComplete, kOnDemand };  ///< before the first ray, or where rays come

  /// In `max_level`: `choose_octree` finds it.
  static constexpr int kAutomatic = 0;

  int max_level = 6;              ///< the root is level 1 (the thesis's counting)
  std::uint32_t max_objects = 0;  ///< a leaf with more is split while its level allows
  Root root = Root::kCube;
  Assign assign = Assign::kSurface;
  double pad = 1e-6;  ///< root's margin on each side, relative to its size
  std::uint64_t max_references = 50'000'000;

  /// Only traversals from the root find their way between planes that lie anywhere; all others
  /// refuse `kCost`.
  Planes planes = Planes::kMedian;
  Build build = Build::kComplete;  ///< `OnDemandOctree` divides on demand; `Octree` never
  int built_level = 4;             ///< divided before the first ray, with `kOnDemand`

  /// The parameters `max_level`, `max_objects`, `root`, `assign`, `pad`, `max_references` that
  /// every structure over an octree offers, and their values read back.
  static std::vector<ParameterInfo> parameters();
  static OctreeOptions from(const Parameters& parameters);

  /// These, and `planes`, `build`, `built_level` of the structures that are traversed from the root
  /// down, and their values read back.
  static std::vector<ParameterInfo> top_down_parameters();
  static OctreeOptions from_top_down(const Parameters& parameters);
};

/// The finest cells of an octree of these options over a scene: its root, divided evenly, into
/// 2^(max_level - 1) cells along each axis where nodes are halved, and into 2^16, to which planes
/// are rounded, where they lie anywhere.
CellGrid octree_grid(const scenes::Scene& scene, const OctreeOptions& options);

/// A part of an octree, where a scene is divided among several processes: its cells of `level` that
/// are not `own` are empty leaves, whatever is in them.
struct OctreePart {
  int level;  ///< not deeper than the octree's `max_level`
  std::function<bool(const glm::ivec3& cell)> own;
  /// Must a node of `size` cells along each axis, from `first` on, be divided? Then all cells of
  /// `level` in it that are such nodes exist, whether this part has primitives there or not.
  std::function<bool(const glm::ivec3& first, std::int32_t size)> divided;
};

/// A node: interior (its eight children are consecutive, child i at first + i, i = x + 2 y + 4 z)
/// or a leaf (its references).
struct OctreeNode {
  static constexpr std::uint32_t kInterior = 0xFFFFFFFFU;

  std::uint32_t parent;  ///< index of the parent; the root's is the root
  std::uint32_t first;   ///< first child, or first reference
  std::uint32_t count;   ///< kInterior, or the number of references

  bool is_leaf() const { return count != kInterior; }
};

/// An octree over a scene: nodes in one array (the root first, children after their parent),
/// references in another. A leaf refers to each primitive whose surface (or box) reaches into its
/// closed cell, widened by `overlap_tolerance`, in increasing id.
class Octree {
 public:
  /// Static subdivision (thesis, section 3.3): the root is split until a node has at most
  /// `max_objects` primitives or lies at `max_level`. Throws InputError naming `max_references`
  /// when the references exceed it.
  Octree(const scenes::Scene& scene, const OctreeOptions& options);

  /// The same as `Octree(scene, options)`, made faster from the octree of a lower `max_level` and
  /// otherwise equal options.
  Octree(const scenes::Scene& scene, const OctreeOptions& options, const Octree& coarser);

  /// A part of an octree, over a scene that has at least all primitives that reach into its own
  /// cells.
  Octree(const scenes::Scene& scene, const OctreeOptions& options, const OctreePart& part);

  /// The finest cells, as many along each axis (`octree_grid`).
  const CellGrid& grid() const { return grid_; }
  /// Is each node halved along each axis? Neighbors are found by coordinates only where it is.
  bool has_central_planes() const { return central_planes_; }
  /// The planes between the children of an interior node, as finest cells. Not of an octree with
  /// central planes.
  glm::ivec3 split_of(const OctreeNode& node) const {
    const auto& split = splits_[(node.first - 1) / 8];
    return {split[0], split[1], split[2]};
  }
  int deepest_level() const { return deepest_level_; }
  /// Of all leaves together.
  std::size_t reference_count() const { return references_.size(); }
  std::span<const OctreeNode> nodes() const { return nodes_; }
  std::span<const scenes::PrimitiveId> references(const OctreeNode& leaf) const {
    return {references_.data() + leaf.first, leaf.count};
  }

  Statistics statistics() const;
  /// The leaves that hold references, in scene units.
  std::vector<Box> occupied_cells() const;

 private:
  friend class OctreeBuilder;

  CellGrid grid_;
  std::vector<OctreeNode> nodes_;
  std::vector<scenes::PrimitiveId> references_;
  /// Of interior nodes, in the order of their children; empty where planes are central.
  std::vector<std::array<std::uint16_t, 3>> splits_;
  scenes::Bounds scene_bounds_;
  bool central_planes_ = true;
  int deepest_level_ = 1;
};

}  // namespace beambench::accel::octree

#pragma once
// The octree of the thesis (section 3.3), shared by all structures that traverse one.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/cell.hpp"
#include "accel/core/cell_grid.hpp"
#include "accel/core/statistics.hpp"
#include "scenes/base/parameters.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::octree {

/// Options for subdividing an octree.
struct OctreeOptions {
  enum class Root { kCube, kBox };          ///< a cube around the scene (thesis), or its own box
  enum class Assign { kSurface, kBounds };  ///< criterion for a reference: surface, or box

  enum class Planes { kMedian, kCost };  ///< halved nodes, or planes with the lowest cost
  /// Whether nodes are divided before the first ray or on demand. kHashed: before the first ray,
  /// and nodes are found by name.
  enum class Build { kComplete, kOnDemand, kHashed };
  enum class Exits { kExplicit, kIterative };  ///< how a leaf's exit is found

  /// The value of `max_level` that makes `choose_octree` find the level.
  static constexpr int kAutomatic = 0;

  int max_level = 6;              ///< the root is level 1 (the thesis's counting)
  std::uint32_t max_objects = 0;  ///< a node with more is split if the level allows
  Root root = Root::kCube;
  Assign assign = Assign::kSurface;
  /// The minimum widening of overlaps in scene units, for a scene that is part of a larger one.
  double least_tolerance = 0.0;
  double pad = 1e-6;  ///< root's margin on each side, relative to its size
  std::uint64_t max_references = 50'000'000;

  /// Only traversals from the root support `kCost`; all others throw for it.
  Planes planes = Planes::kMedian;
  Exits exits = Exits::kExplicit;
  Build build = Build::kComplete;  ///< `OnDemandOctree` divides on demand, `Octree` never
  int built_level = 4;             ///< the level built before the first ray, with `kOnDemand`

  /// Returns the parameters `max_level`, `max_objects`, `root`, `assign`, `pad` and
  /// `max_references` of every structure over an octree.
  static std::vector<ParameterInfo> parameters();
  static OctreeOptions from(const Parameters& parameters);

  /// Returns these parameters plus `planes`, `build` and `built_level`, for structures traversed
  /// from the root down.
  static std::vector<ParameterInfo> top_down_parameters();
  static OctreeOptions from_top_down(const Parameters& parameters);

  /// Returns these parameters plus `exits`, for the structure that searches from the root.
  static std::vector<ParameterInfo> root_search_parameters();
  static OctreeOptions from_root_search(const Parameters& parameters);
};

/// Returns the finest cells of an octree with these options over a scene: its root, divided evenly
/// along each axis into 2^(max_level - 1) cells if nodes are halved, or into 2^16 cells, to which
/// planes are rounded, if planes are arbitrary.
CellGrid octree_grid(const scenes::Scene& scene, const OctreeOptions& options);

/// A part of an octree, for a scene divided among several processes: cells of `level` for which
/// `own` is false are empty leaves, whatever they contain.
struct OctreePart {
  int level;  ///< not deeper than the octree's `max_level`
  std::function<bool(const glm::ivec3& cell)> own;
  /// Returns whether a node above `level`, of `size` cells along each axis from `first` on, must be
  /// divided, whether or not this part has primitives in it.
  std::function<bool(const glm::ivec3& first, std::int32_t size)> divided;
};

/// A node: interior (with eight consecutive children, child i = x + 2 y + 4 z at first + i) or a
/// leaf (with its references).
struct OctreeNode {
  static constexpr std::uint32_t kInterior = 0xFFFFFFFFU;

  std::uint32_t parent;  ///< index of the parent; for the root, its own index
  std::uint32_t first;   ///< first child, or first reference
  std::uint32_t count;   ///< kInterior, or the number of references

  bool is_leaf() const { return count != kInterior; }
};

/// An octree over a scene: nodes in one array (the root first, children after their parent),
/// references in another. A leaf refers to each primitive whose surface (or box) overlaps its
/// closed cell, widened by `overlap_tolerance`, in order of id.
class Octree {
 public:
  /// Divides statically (thesis, section 3.3): nodes are split until they have at most
  /// `max_objects` primitives or are at `max_level`. Throws an InputError that names
  /// `max_references` if there are more references.
  Octree(const scenes::Scene& scene, const OctreeOptions& options);

  /// Builds the same octree as `Octree(scene, options)`, but faster, from an octree with a lower
  /// `max_level` and otherwise equal options.
  Octree(const scenes::Scene& scene, const OctreeOptions& options, const Octree& coarser);

  /// Builds a part of an octree over a scene that includes all primitives overlapping the part's
  /// own cells.
  Octree(const scenes::Scene& scene, const OctreeOptions& options, const OctreePart& part);

  /// Returns the finest cells, equally many along each axis (`octree_grid`).
  const CellGrid& grid() const { return grid_; }
  /// Returns whether each node is halved along each axis, as required to find neighbors by
  /// coordinates.
  bool has_central_planes() const { return central_planes_; }
  /// Returns the planes between the children of an interior node, as finest cells. The octree must
  /// not have central planes.
  glm::ivec3 split_of(const OctreeNode& node) const {
    const auto& split = splits_[(node.first - 1) / 8];
    return {split[0], split[1], split[2]};
  }
  int deepest_level() const { return deepest_level_; }
  /// Returns the number of references in all leaves.
  std::size_t reference_count() const { return references_.size(); }
  std::span<const OctreeNode> nodes() const { return nodes_; }
  std::span<const scenes::PrimitiveId> references(const OctreeNode& leaf) const {
    return {references_.data() + leaf.first, leaf.count};
  }

  Statistics statistics() const;
  /// Returns the leaves that hold references.
  std::vector<Cell> occupied_cells() const;

 private:
  friend class OctreeBuilder;

  CellGrid grid_;
  std::vector<OctreeNode> nodes_;
  std::vector<scenes::PrimitiveId> references_;
  /// The planes of interior nodes, in the order of their children; empty if planes are central.
  std::vector<std::array<std::uint16_t, 3>> splits_;
  scenes::Bounds scene_bounds_;
  bool central_planes_ = true;
  int deepest_level_ = 1;
};

}  // namespace beambench::accel::octree

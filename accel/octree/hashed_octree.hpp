#pragma once
// An octree whose nodes are found by name in a hash table.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/cell_grid.hpp"
#include "accel/core/overlap.hpp"
#include "accel/core/statistics.hpp"
#include "accel/octree/node_division.hpp"
#include "accel/octree/octree.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::octree {

/// The linear octree of the thesis (section 2.2.2): a node has no links. Its name is the sequence
/// of child numbers on the path from the root, as octal digits after a 1 (Gargantini, "An effective
/// way to represent quadtrees", CACM 25(12), 1982), and a hash table maps names to nodes, as in
/// Glassner ("Space subdivision for fast ray tracing", IEEE CG&A 4(10), 1984). Here the table also
/// contains interior nodes, so that a search ends at a leaf. The nodes are those of `Octree`; their
/// unused links remain and are included in the bytes.
class HashedOctree {
 public:
  static constexpr std::uint64_t kRootName = 1;

  HashedOctree(const scenes::Scene& scene, const OctreeOptions& options)
      : HashedOctree(Octree(scene, options)) {}
  explicit HashedOctree(Octree octree);

  const CellGrid& grid() const { return octree_.grid(); }
  std::span<const scenes::PrimitiveId> references(const OctreeNode& leaf) const {
    return octree_.references(leaf);
  }
  /// Returns the index in `Octree::nodes` of the node with this name, which must exist.
  std::uint32_t number_of(std::uint64_t name) const {
    std::size_t slot = slot_of(name);
    while (names_[slot] != name) slot = (slot + 1) & mask_;
    return numbers_[slot];
  }
  const OctreeNode& node(std::uint32_t number) const { return octree_.nodes()[number]; }
  /// Returns the planes between the children of the interior node of a cell.
  glm::ivec3 split_of(const OctreeNode& node, const OctreeCell& cell) const {
    return octree_.has_central_planes() ? cell.corner + cell.size / 2 : octree_.split_of(node);
  }

  Statistics statistics() const;
  std::vector<Cell> occupied_cells() const { return octree_.occupied_cells(); }

 private:
  std::size_t slot_of(std::uint64_t name) const {
    // Fibonacci hashing (Knuth, The Art of Computer Programming 3, section 6.4).
    return static_cast<std::size_t>(name * 0x9E3779B97F4A7C15U >> shift_);
  }
  void insert(std::uint32_t number, std::uint64_t name);

  Octree octree_;
  std::size_t mask_;
  int shift_;
  std::vector<std::uint64_t> names_;  ///< 0 for a free slot
  std::vector<std::uint32_t> numbers_;
};

/// A node of a hashed octree with its box.
class HashedCursor {
 public:
  using Tree = HashedOctree;

  /// Starts at the root.
  explicit HashedCursor(const HashedOctree& octree)
      : octree_(&octree),
        number_(octree.number_of(HashedOctree::kRootName)),
        cell_{glm::ivec3(0), octree.grid().cells, 1} {}

  const OctreeNode& node() const { return octree_->node(number_); }
  bool is_leaf() const { return node().is_leaf(); }
  std::uint32_t index() const { return number_; }
  const glm::ivec3& corner() const { return cell_.corner; }
  const glm::ivec3& size() const { return cell_.size; }
  int level() const { return cell_.level; }
  /// Returns the planes between the children, as finest cells. Must not be called for a leaf.
  glm::ivec3 split() const { return octree_->split_of(node(), cell_); }

  /// Descends to a child by its number (x + 2 y + 4 z). Must not be called for a leaf.
  void enter(std::uint32_t octant) {
    cell_ = cell_.child(split(), octant);
    name_ = 8 * name_ + octant;
    number_ = octree_->number_of(name_);
  }

 private:
  const HashedOctree* octree_;
  std::uint64_t name_ = HashedOctree::kRootName;
  std::uint32_t number_;
  OctreeCell cell_;
};

}  // namespace beambench::accel::octree

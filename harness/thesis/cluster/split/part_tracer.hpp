#pragma once
// Traces single rays through a process's part of a scene, up to its border.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "accel/core/cell_ray.hpp"
#include "accel/core/ray.hpp"
#include "accel/octree/samet.hpp"
#include "harness/thesis/cluster/split/scene_split.hpp"

namespace beambench::cluster {

/// The leaves of a process's octree that represent other processes' cells.
class ForeignLeaves {
 public:
  ForeignLeaves(const accel::octree::Octree& octree, const SceneSplit& split, ProcessId self);

  /// Returns the cell of another process that a leaf represents, if any.
  std::optional<std::uint32_t> cell_at(std::uint32_t leaf) const {
    if (cells_[leaf] == kOwn) return std::nullopt;
    return cells_[leaf];
  }
  std::size_t memory_bytes() const { return cells_.capacity() * sizeof(std::uint32_t); }

 private:
  static constexpr std::uint32_t kOwn = 0xFFFFFFFFU;
  std::vector<std::uint32_t> cells_;  ///< by node
};

/// Returns the node of a cell of a split.
accel::octree::OctreeCursor cursor_of_cell(const accel::octree::Octree& octree,
                                           const SceneSplit& split, std::uint32_t cell);

/// The best hit of a ray that has not hit anything.
inline constexpr accel::Hit kNoHit{accel::kInfinity, scenes::kNoPrimitive};

/// Traces each ray from where it begins or enters this part to where it ends or enters another
/// process's cell. The combined hits of all parts along a ray equal those of a single process, bit
/// for bit: a ray carries its best hit, which limits the search, and ties in t are decided by the
/// ids of the whole scene. Queries are const and thread-safe.
class PartTracer {
 public:
  /// All arguments must outlive this object.
  PartTracer(const ScenePart& part, const accel::octree::Samet& tracer, const SceneSplit& split,
             const ForeignLeaves& foreign)
      : part_(&part), tracer_(&tracer), split_(&split), foreign_(&foreign) {}

  /// The position of a ray in this part's octree.
  struct Place {
    accel::octree::OctreeCursor cursor;
    double t;
  };
  /// Returns the place where a ray begins, even outside this part; nothing if the ray misses the
  /// root.
  std::optional<Place> beginning(const accel::Ray& ray) const;
  /// Returns the place where a ray enters one of this process's cells at t.
  Place entry(std::uint32_t cell, double t) const;

  /// The place where a ray enters another process's cell.
  struct Exit {
    std::uint32_t cell;
    double t;
  };
  /// The result of a ray so far, and where it continues.
  struct Passage {
    accel::Hit best;  ///< with the id in the whole scene
    std::optional<Exit> exit;
  };
  /// Continues a ray whose best hit so far is `best`.
  Passage closest(const accel::Ray& ray, const Place& from, const accel::Hit& best) const;
  /// Continues a ray that ends at any hit and has not hit anything so far.
  Passage any(const accel::Ray& ray, const Place& from) const;

  accel::Hit global(const std::optional<accel::Hit>& local) const {
    if (!local) return kNoHit;
    return {local->t, part_->global[local->primitive]};
  }

 private:
  template <class Test>
  std::optional<Exit> walk(const accel::Ray& ray, const Place& from, Test test) const;

  const ScenePart* part_;
  const accel::octree::Samet* tracer_;
  const SceneSplit* split_;
  const ForeignLeaves* foreign_;
};

}  // namespace beambench::cluster

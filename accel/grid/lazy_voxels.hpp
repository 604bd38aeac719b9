#pragma once
// The voxels' lists, each built when the first ray enters the voxel.

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "accel/core/cell_grid.hpp"
#include "accel/core/statistics.hpp"
#include "accel/grid/assign.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::grid {

/// The grid of the thesis: nothing is built in advance. When the first ray enters a voxel, every
/// primitive of the scene is tested for overlap with it; the first test uses the primitive's range
/// of voxels. The lists are those of `EagerVoxels`, except that more cones may be listed: their
/// overlap test is conservative.
///
/// Several threads may query at once. A thread that finds no list builds one and publishes it by
/// compare-exchange; a thread that comes second discards its own, identical list.
class LazyVoxels {
 public:
  LazyVoxels(const scenes::Scene& scene, const CellGrid& grid, std::uint64_t max_references,
             Assign assign = Assign::kSurface);
  LazyVoxels(const LazyVoxels&) = delete;
  LazyVoxels& operator=(const LazyVoxels&) = delete;
  ~LazyVoxels();

  /// Returns a voxel's references. Throws an InputError that names `max_references` if the lists
  /// made so far have more references.
  std::span<const scenes::PrimitiveId> references(std::size_t voxel) const {
    const List* list = lists_[voxel].load(std::memory_order_acquire);
    if (list == nullptr) list = &publish(voxel, evaluate(voxel));
    return *list;
  }
  /// Returns whether the voxel has been evaluated and has references. Does not evaluate it.
  bool holds_references(std::size_t voxel) const {
    const List* list = lists_[voxel].load(std::memory_order_acquire);
    return list != nullptr && list != &empty_;
  }
  /// Fills in the statistics of the voxels evaluated so far.
  void describe(Statistics& statistics) const;

 private:
  using List = std::vector<scenes::PrimitiveId>;

  /// Returns a voxel's list, or nullptr for a voxel without references.
  std::unique_ptr<const List> evaluate(std::size_t voxel) const;
  /// Publishes a list. Returns the list that all threads see from now on: this one or an earlier
  /// one.
  const List& publish(std::size_t voxel, std::unique_ptr<const List> list) const;

  const scenes::Scene& scene_;
  CellGrid grid_;
  double tolerance_;
  std::uint64_t max_references_;
  Assign assign_;
  std::vector<CellRange> ranges_;  ///< voxels of each primitive's box
  /// Shared by all empty voxels, which are the majority.
  const List empty_;
  // Mutable because queries add lists, the same ones whatever their order. This object owns them.
  mutable std::vector<std::atomic<const List*>> lists_;
  mutable std::atomic<std::uint64_t> references_made_{0};
};

}  // namespace beambench::accel::grid

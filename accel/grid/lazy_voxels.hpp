#pragma once
// The voxels' lists, each made when the first ray enters.

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

/// The grid of the thesis: nothing is built; the first ray that enters a voxel has every primitive
/// of the scene tested for overlap with it, its range of voxels first. The lists are those of
/// `EagerVoxels` (that of a cone may be longer: its overlap test is conservative).
///
/// Several threads may query at once. A thread that finds no list makes one and publishes it by
/// compare-exchange; the second to do so discards its own, which is the same.
class LazyVoxels {
 public:
  LazyVoxels(const scenes::Scene& scene, const CellGrid& grid, std::uint64_t max_references,
             Assign assign = Assign::kSurface);
  LazyVoxels(const LazyVoxels&) = delete;
  LazyVoxels& operator=(const LazyVoxels&) = delete;
  ~LazyVoxels();

  /// Throws InputError naming `max_references` when the lists made so far exceed it.
  std::span<const scenes::PrimitiveId> references(std::size_t voxel) const {
    const List* list = lists_[voxel].load(std::memory_order_acquire);
    if (list == nullptr) list = &publish(voxel, evaluate(voxel));
    return *list;
  }
  /// Has it been evaluated, and references were found? Evaluates nothing.
  bool holds_references(std::size_t voxel) const {
    const List* list = lists_[voxel].load(std::memory_order_acquire);
    return list != nullptr && list != &empty_;
  }
  /// Fills in what has been evaluated so far.
  void describe(Statistics& statistics) const;

 private:
  using List = std::vector<scenes::PrimitiveId>;

  /// Nothing where nothing reaches into the voxel.
  std::unique_ptr<const List> evaluate(std::size_t voxel) const;
  /// The list that all threads see from now on: this one or an earlier one.
  const List& publish(std::size_t voxel, std::unique_ptr<const List> list) const;

  const scenes::Scene& scene_;
  CellGrid grid_;
  double tolerance_;
  std::uint64_t max_references_;
  Assign assign_;
  std::vector<CellRange> ranges_;  ///< by primitive
  /// Shared by all empty voxels, which are most.
  const List empty_;
  // Mutable: what a query adds is what any other query would have found. The lists are owned.
  mutable std::vector<std::atomic<const List*>> lists_;
  mutable std::atomic<std::uint64_t> references_made_{0};
};

}  // namespace beambench::accel::grid

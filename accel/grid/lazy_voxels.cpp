#include "accel/grid/lazy_voxels.hpp"

#include <utility>

#include "accel/core/tolerance.hpp"
#include "accel/grid/grid_layout.hpp"
#include "accel/grid/voxel_walk.hpp"

namespace beambench::accel::grid {

LazyVoxels::LazyVoxels(const scenes::Scene& scene, const CellGrid& grid,
                       std::uint64_t max_references, Assign assign)
    : scene_(scene),
      grid_(grid),
      tolerance_(overlap_tolerance(scene)),
      max_references_(max_references),
      assign_(assign),
      lists_(voxel_count(grid)) {
  ranges_.reserve(scene.primitives.size());
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    ranges_.push_back(cell_range(grid_, scenes::primitive_bounds(scene, id), tolerance_));
  }
}

LazyVoxels::~LazyVoxels() {
  for (const auto& slot : lists_) {
    const List* list = slot.load(std::memory_order_relaxed);
    if (list != &empty_) std::unique_ptr<const List>(list).reset();
  }
}

std::unique_ptr<const LazyVoxels::List> LazyVoxels::evaluate(std::size_t voxel) const {
  const glm::ivec3 place = voxel_at(grid_, voxel);
  const Box box = grid_.box(place, 1);
  List found;
  for (scenes::PrimitiveId id = 0; id < scene_.primitives.size(); ++id) {
    if (ranges_[id].contains(place) &&
        (assign_ == Assign::kBounds || surface_overlaps(scene_, id, box, tolerance_))) {
      found.push_back(id);
    }
  }
  if (found.empty()) return nullptr;
  found.shrink_to_fit();
  return std::make_unique<const List>(std::move(found));
}

const LazyVoxels::List& LazyVoxels::publish(std::size_t voxel,
                                            std::unique_ptr<const List> list) const {
  const List* mine = list ? list.get() : &empty_;
  const List* earlier = nullptr;
  if (!lists_[voxel].compare_exchange_strong(earlier, mine, std::memory_order_acq_rel)) {
    return *earlier;
  }
  static_cast<void>(list.release());  // now owned by lists_
  const std::uint64_t before = references_made_.fetch_add(mine->size(), std::memory_order_relaxed);
  if (before + mine->size() > max_references_) {
    fail_too_many_references(scene_, grid_, max_references_);
  }
  return *mine;
}

void LazyVoxels::describe(Statistics& statistics) const {
  std::uint64_t evaluated = 0;
  for (const auto& slot : lists_) {
    const List* list = slot.load(std::memory_order_acquire);
    if (list == nullptr) continue;
    ++evaluated;
    if (list == &empty_) {
      ++statistics.empty_leaves;
      continue;
    }
    statistics.references += list->size();
    statistics.bytes += sizeof(List) + list->capacity() * sizeof(scenes::PrimitiveId);
  }
  statistics.bytes +=
      lists_.capacity() * sizeof(lists_[0]) + ranges_.capacity() * sizeof(CellRange);
  statistics.more.emplace_back("evaluated_voxels", static_cast<double>(evaluated));
  statistics.more.emplace_back("evaluated_share",
                               static_cast<double>(evaluated) / static_cast<double>(lists_.size()));
}

}  // namespace beambench::accel::grid

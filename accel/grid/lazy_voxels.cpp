#include "accel/grid/lazy_voxels.hpp"

#include <algorithm>

#include "accel/grid/reference_cap.hpp"
#include "accel/grid/voxel_walk.hpp"
#include "accel/tolerance.hpp"

namespace beambench {

namespace {

/// What all empty voxels point to: most are empty, and none needs memory of its own.
constexpr PrimitiveId kEmptyList[1] = {0};

}  // namespace

LazyVoxels::LazyVoxels(const Scene& scene, const CellGrid& grid, std::uint64_t max_references)
    : scene_(scene),
      grid_(grid),
      tolerance_(overlap_tolerance(scene)),
      max_references_(max_references),
      lists_(voxel_count(grid)) {
  ranges_.reserve(scene.primitives.size());
  for (PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    ranges_.push_back(cell_range(grid_, primitive_bounds(scene, id), tolerance_));
  }
}

LazyVoxels::~LazyVoxels() {
  for (const auto& list : lists_) {
    const PrimitiveId* held = list.load(std::memory_order_relaxed);
    if (held != kEmptyList) List(held).reset();
  }
}

LazyVoxels::List LazyVoxels::evaluate(std::size_t voxel) const {
  const glm::ivec3 place = voxel_at(grid_, voxel);
  const Box box = grid_.box(place, 1);
  std::vector<PrimitiveId> found;
  for (PrimitiveId id = 0; id < scene_.primitives.size(); ++id) {
    if (ranges_[id].contains(place) && surface_overlaps(scene_, id, box, tolerance_)) {
      found.push_back(id);
    }
  }
  if (found.empty()) return nullptr;
  auto list = std::make_unique<PrimitiveId[]>(found.size() + 1);
  list[0] = static_cast<PrimitiveId>(found.size());
  std::copy(found.begin(), found.end(), list.get() + 1);
  return list;
}

const PrimitiveId* LazyVoxels::publish(std::size_t voxel, List list) const {
  const PrimitiveId* mine = list ? list.get() : kEmptyList;
  const PrimitiveId* published = nullptr;
  if (!lists_[voxel].compare_exchange_strong(published, mine, std::memory_order_acq_rel)) {
    return published;
  }
  list.release();  // now it belongs to lists_
  if (references_made_.fetch_add(mine[0], std::memory_order_relaxed) + mine[0] > max_references_) {
    fail_too_many_references(scene_, grid_, max_references_);
  }
  return mine;
}

void LazyVoxels::describe(Statistics& statistics) const {
  std::uint64_t evaluated = 0;
  for (const auto& slot : lists_) {
    const PrimitiveId* list = slot.load(std::memory_order_acquire);
    if (list == nullptr) continue;
    ++evaluated;
    if (list[0] == 0) {
      ++statistics.empty_leaves;
      continue;
    }
    statistics.references += list[0];
    statistics.bytes += (list[0] + 1) * sizeof(PrimitiveId);
  }
  statistics.bytes +=
      lists_.capacity() * sizeof(lists_[0]) + ranges_.capacity() * sizeof(CellRange);
  statistics.more.emplace_back("evaluated_voxels", static_cast<double>(evaluated));
  statistics.more.emplace_back("evaluated_share",
                               static_cast<double>(evaluated) / static_cast<double>(lists_.size()));
}

}  // namespace beambench

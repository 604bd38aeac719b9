#include "accel/octree/cost_planes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace beambench::accel::octree {
namespace {

constexpr int kPositions = 10;

/// The part of a primitive's cells along an axis that lies in a node.
struct Extent {
  std::int32_t first;
  std::int32_t last;
};

/// Returns the plane that has as many centers below it as above it.
std::int32_t object_median(std::span<const Extent> extents, std::vector<std::int32_t>& centers) {
  centers.clear();
  for (const Extent& extent : extents) centers.push_back((extent.first + extent.last + 1) / 2);
  const auto middle = centers.begin() + static_cast<std::ptrdiff_t>(centers.size() / 2);
  std::nth_element(centers.begin(), middle, centers.end());
  return *middle;
}

/// Returns half the area of a box, which suffices because costs are only compared.
double half_area(const glm::dvec3& size) {
  return size.x * size.y + size.y * size.z + size.z * size.x;
}

/// Finds the best plane across one axis of a node.
class PlaneSearch {
 public:
  PlaneSearch(const CellGrid& grid, const glm::ivec3& corner, const glm::ivec3& size)
      : grid_(&grid), corner_(corner), size_(size) {}

  std::int32_t find(int axis, std::span<const CellRange> ranges,
                    std::span<const scenes::PrimitiveId> primitives) {
    collect(axis, ranges, primitives);
    const std::int32_t spatial = corner_[axis] + size_[axis] / 2;
    const std::int32_t objects = extents_.empty() ? spatial : object_median(extents_, centers_);
    std::int32_t best = spatial;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kPositions; ++i) {
      const double part = (i + 1.0) / (kPositions + 1.0);
      const auto position =
          spatial + static_cast<std::int32_t>(std::lround(part * (objects - spatial)));
      const std::int32_t plane =
          std::clamp(position, corner_[axis] + 1, corner_[axis] + size_[axis] - 1);
      const double cost = cost_of(axis, plane);
      if (cost >= least) continue;
      least = cost;
      best = plane;
    }
    return best;
  }

 private:
  void collect(int axis, std::span<const CellRange> ranges,
               std::span<const scenes::PrimitiveId> primitives) {
    const auto slot = static_cast<std::size_t>(axis);
    const std::int32_t first = corner_[axis];
    const std::int32_t last = first + size_[axis] - 1;
    extents_.clear();
    for (const scenes::PrimitiveId id : primitives) {
      extents_.push_back({std::max<std::int32_t>(ranges[id].first[slot], first),
                          std::min<std::int32_t>(ranges[id].last[slot], last)});
    }
  }

  double cost_of(int axis, std::int32_t plane) const {
    std::int64_t below = 0;
    std::int64_t above = 0;
    for (const Extent& extent : extents_) {
      below += extent.first < plane ? 1 : 0;
      above += extent.last >= plane ? 1 : 0;
    }
    glm::dvec3 low = grid_->cell * glm::dvec3(size_);
    glm::dvec3 high = low;
    low[axis] = grid_->cell[axis] * (plane - corner_[axis]);
    high[axis] = grid_->cell[axis] * (corner_[axis] + size_[axis] - plane);
    return half_area(low) * static_cast<double>(below) +
           half_area(high) * static_cast<double>(above);
  }

  const CellGrid* grid_;
  glm::ivec3 corner_;
  glm::ivec3 size_;
  std::vector<Extent> extents_;
  std::vector<std::int32_t> centers_;
};

}  // namespace

glm::ivec3 cost_planes(const CellGrid& grid, const glm::ivec3& corner, const glm::ivec3& size,
                       std::span<const CellRange> ranges,
                       std::span<const scenes::PrimitiveId> primitives) {
  PlaneSearch search(grid, corner, size);
  return {search.find(0, ranges, primitives), search.find(1, ranges, primitives),
          search.find(2, ranges, primitives)};
}

}  // namespace beambench::accel::octree

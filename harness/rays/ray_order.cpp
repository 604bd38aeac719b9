#include "harness/rays/ray_order.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace beambench::rays {
namespace {

/// Returns one of 128 direction bins: 8 octants, each a triangle divided into 4x4 cells.
std::uint64_t direction_bin(const glm::vec3& direction) {
  constexpr double kCells = 4.0;
  const double x = std::abs(direction.x), y = std::abs(direction.y), z = std::abs(direction.z);
  const auto cell = [&](double part) {
    return static_cast<std::uint64_t>(std::min(part / (x + y + z) * kCells, kCells - 1.0));
  };
  const std::uint64_t octant = (direction.x < 0.0F ? 1U : 0U) | (direction.y < 0.0F ? 2U : 0U) |
                               (direction.z < 0.0F ? 4U : 0U);
  return octant << 4U | cell(x) << 2U | cell(y);
}

/// Returns ten bits, each followed by two zeros.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 16U) & 0x030000ffU;
  bits = (bits | bits << 8U) & 0x0300f00fU;
  bits = (bits | bits << 4U) & 0x030c30c3U;
  return (bits | bits << 2U) & 0x09249249U;
}

/// Returns the index of a point along a Morton curve through the bounds. For a point outside,
/// returns that of the nearest point inside.
std::uint64_t morton_place(const glm::vec3& point, const scenes::Bounds& bounds) {
  constexpr double kSteps = 1024.0;
  std::uint64_t place = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = bounds.lower[axis], size = bounds.upper[axis] - low;
    const double part = size > 0.0 ? (point[axis] - low) / size : 0.0;
    const double step = std::clamp(part * kSteps, 0.0, kSteps - 1.0);
    place |= spread(static_cast<std::uint64_t>(step)) << static_cast<unsigned>(axis);
  }
  return place;
}

}  // namespace

void sort_rays(RayList& list, const scenes::Bounds& bounds) {
  constexpr unsigned kMortonBits = 30;
  std::vector<std::pair<std::uint64_t, std::uint32_t>>
      order;  // unique, so equal keys stay in order
  order.reserve(list.rays.size());
  for (const accel::Ray& ray : list.rays) {
    order.emplace_back(
        direction_bin(ray.direction) << kMortonBits | morton_place(ray.origin, bounds),
        static_cast<std::uint32_t>(order.size()));
  }
  std::ranges::sort(order);
  RayList sorted;
  sorted.image = std::move(list.image);
  sorted.rays.reserve(order.size());
  for (const auto& [key, index] : order) {
    sorted.rays.push_back(list.rays[index]);
    if (!list.samples.empty()) sorted.samples.push_back(list.samples[index]);
  }
  list = std::move(sorted);
}

}  // namespace beambench::rays

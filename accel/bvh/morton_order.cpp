#include "accel/bvh/morton_order.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "accel/bvh/box_quads.hpp"
#include "accel/bvh/item_ranges.hpp"

namespace beambench::accel::bvh {
namespace {

constexpr std::uint32_t kCodeBits = 30;

/// Returns twice the center, which saves a multiplication.
Quad center_of(const scenes::Bounds& box) { return quad_of(box.lower) + quad_of(box.upper); }

/// Maps centers to codes.
class MortonGrid {
 public:
  explicit MortonGrid(const scenes::Bounds& centers) : lower_(quad_of(centers.lower)), scale_{} {
    glm::vec3 side = centers.extent();
    std::array<std::uint32_t, 3> bits{};                          // number of bits of each axis
    std::array<std::array<std::uint32_t, kCodeBits>, 3> place{};  // bit places, the highest first
    for (std::uint32_t bit = kCodeBits; bit-- > 0;) {
      int axis = side.y > side.x ? 1 : 0;
      if (side.z > side[axis]) axis = 2;
      const auto row = static_cast<std::size_t>(axis);
      place[row][bits[row]++] = bit;
      side[axis] *= 0.5F;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto cells = static_cast<float>(1U << bits[axis]);
      const float extent = centers.extent()[static_cast<int>(axis)];
      const float scale = cells / extent;
      // An extent so small that its inverse overflows cannot be divided.
      if (extent > 0.0F && scale < kFar) scale_[axis] = scale;
      // The largest float below 2^30, because 2^30 - 1 itself would be rounded up.
      last_[axis] = std::min(cells - 1.0F, 0x1.fffffep29F);
      for (std::uint32_t i = 0; i < bits[axis]; ++i) {
        const std::uint32_t from = bits[axis] - 1 - i;
        for (std::uint32_t value = 0; value < 256; ++value) {
          if ((value >> from % 8 & 1U) != 0) spread_[axis][from / 8][value] |= 1U << place[axis][i];
        }
      }
    }
  }

  std::uint32_t code(const scenes::Bounds& box) const {
    const Quad place = smaller((center_of(box) - lower_) * scale_, last_);
    const IntQuad cell = __builtin_convertvector(place, IntQuad);
    std::uint32_t code = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<std::uint32_t>(cell[axis]);
      code |= spread_[axis][0][at & 255U] | spread_[axis][1][at >> 8U & 255U];
      if (at >> 16U == 0) continue;  // always the case in scenes that are not flat
      code |= spread_[axis][2][at >> 16U & 255U] | spread_[axis][3][at >> 24U];
    }
    return code;
  }

 private:
  static constexpr float kFar = std::numeric_limits<float>::infinity();

  Quad lower_;
  Quad scale_;
  Quad last_{};
  /// The bits of a code that come from a byte of a cell's coordinate.
  std::array<std::array<std::array<std::uint32_t, 256>, 4>, 3> spread_{};
};

/// Sorts by ten bits of the code; the sort is stable.
void sort_by_digit(std::span<const MortonKey> from, std::span<MortonKey> to, unsigned shift,
                   const ItemRanges& ranges) {
  constexpr std::size_t kDigits = 1024;
  using Counts = std::array<std::uint32_t, kDigits>;
  const auto digit = [&](MortonKey key) { return key >> shift & (kDigits - 1); };
  std::vector<Counts> places(ranges.count());
  ranges.for_each([&](std::size_t range, std::size_t begin, std::size_t end) {
    Counts& counts = places[range];
    counts.fill(0);
    for (std::size_t i = begin; i < end; ++i) ++counts[digit(from[i])];
  });
  std::uint32_t place = 0;
  for (std::size_t i = 0; i < kDigits; ++i) {
    for (Counts& counts : places) place += std::exchange(counts[i], place);
  }
  ranges.for_each([&](std::size_t range, std::size_t begin, std::size_t end) {
    Counts& next = places[range];
    for (std::size_t i = begin; i < end; ++i) to[next[digit(from[i])]++] = from[i];
  });
}

}  // namespace

UnsetLargePageVector<MortonKey> morton_order(std::span<const scenes::Bounds> boxes, bool parallel) {
  const ItemRanges ranges(boxes.size(), parallel);
  std::vector<QuadBox> extents(ranges.count(), QuadBox::empty());
  ranges.for_each([&](std::size_t range, std::size_t begin, std::size_t end) {
    QuadBox extent = QuadBox::empty();
    for (std::size_t i = begin; i < end; ++i) extent.include(center_of(boxes[i]));
    extents[range] = extent;
  });
  QuadBox extent = QuadBox::empty();
  for (const QuadBox& part : extents) extent.include(part);
  const MortonGrid grid(extent.bounds());
  UnsetLargePageVector<MortonKey> keys(boxes.size());
  UnsetLargePageVector<MortonKey> sorted(boxes.size());
  ranges.for_each([&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) keys[i] = MortonKey{grid.code(boxes[i])} << 32U | i;
  });
  for (unsigned shift = 32; shift < 32 + kCodeBits; shift += 10) {
    sort_by_digit(keys, sorted, shift, ranges);
    keys.swap(sorted);
  }
  return keys;
}

}  // namespace beambench::accel::bvh

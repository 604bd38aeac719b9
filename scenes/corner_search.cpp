#include "scenes/corner_search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include <glm/common.hpp>

namespace beambench::scenes {
namespace {

constexpr std::uint32_t kWordBits = 64;

/// Returns whether a point of the rectangle can lie to the left of the line from a to b, or on it.
/// `signed_area` is monotonic, so rounding never makes this false for a point whose own area is
/// nonnegative.
template <class Rectangle>
bool may_be_left(const glm::dvec2& a, const glm::dvec2& b, const Rectangle& box) {
  const glm::dvec2 most_left{b.y - a.y >= 0.0 ? box.lower.x : box.upper.x,
                             b.x - a.x >= 0.0 ? box.upper.y : box.lower.y};
  return signed_area(a, b, most_left) >= 0.0;
}

}  // namespace

CornerSet::CornerSet(std::uint32_t size) {
  std::size_t numbers = std::max(size, std::uint32_t{1});
  std::size_t words = 0;
  do {
    numbers = (numbers + kWordBits - 1) / kWordBits;
    levels_.push_back({words, numbers});
    words += numbers;
  } while (numbers > 1);
  words_.resize(words);
}

void CornerSet::assign(std::uint32_t number, bool member) {
  for (const Level& level : levels_) {
    std::uint64_t& word = words_[level.first + number / kWordBits];
    const std::uint64_t bit = std::uint64_t{1} << (number % kWordBits);
    word = member ? word | bit : word & ~bit;
    member = word != 0;
    number /= kWordBits;
  }
}

std::optional<std::uint32_t> CornerSet::next(std::uint32_t number) const {
  const auto found = next_not_around(number);
  return found || number == 0 ? found : next_not_around(0);
}

std::optional<std::uint32_t> CornerSet::next_not_around(std::uint32_t number) const {
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    if (number / kWordBits >= levels_[level].words) return std::nullopt;
    const std::uint64_t rest =
        words_[levels_[level].first + number / kWordBits] >> (number % kWordBits);
    if (rest != 0) {
      number += static_cast<std::uint32_t>(std::countr_zero(rest));
      while (level > 0) {
        --level;
        number = number * kWordBits + static_cast<std::uint32_t>(
                                          std::countr_zero(words_[levels_[level].first + number]));
      }
      return number;
    }
    number = number / kWordBits + 1;
  }
  return std::nullopt;
}

CornerTree::CornerTree(std::span<const glm::dvec2> points, std::vector<std::uint32_t> corners)
    : points_(points), slots_(std::move(corners)) {
  if (slots_.empty()) return;
  constexpr std::size_t kMaxInALeaf = 8;
  nodes_.resize(2 * std::bit_ceil((slots_.size() + kMaxInALeaf - 1) / kMaxInALeaf));
  leaf_of_.resize(points_.size(), kNoLeaf);
  build(kRoot);
}

std::pair<std::size_t, std::size_t> CornerTree::slots_of(std::size_t node) const {
  const std::size_t level = std::bit_floor(node);  // both first node and node count of the level
  const std::size_t place = node - level;
  return {slots_.size() * place / level, slots_.size() * (place + 1) / level};
}

void CornerTree::build(std::size_t node) {
  const auto [first, end] = slots_of(node);
  Rectangle box{points_[slots_[first]], points_[slots_[first]]};
  for (std::size_t slot = first; slot < end; ++slot) {
    box.lower = glm::min(box.lower, points_[slots_[slot]]);
    box.upper = glm::max(box.upper, points_[slots_[slot]]);
  }
  nodes_[node] = {box, static_cast<std::uint32_t>(end - first)};
  if (is_leaf(node)) {
    for (std::size_t slot = first; slot < end; ++slot) {
      leaf_of_[slots_[slot]] = static_cast<std::uint32_t>(node);
    }
    return;
  }
  const glm::dvec2 size = box.upper - box.lower;
  const int axis = size.x >= size.y ? 0 : 1;
  const auto begin = slots_.begin();
  std::nth_element(begin + static_cast<std::ptrdiff_t>(first),
                   begin + static_cast<std::ptrdiff_t>(slots_of(2 * node).second),
                   begin + static_cast<std::ptrdiff_t>(end), [&](std::uint32_t i, std::uint32_t j) {
                     return points_[i][axis] < points_[j][axis];
                   });
  build(2 * node);
  build(2 * node + 1);
}

std::optional<std::uint32_t> CornerTree::find_in_triangle(const glm::dvec2& a, const glm::dvec2& b,
                                                          const glm::dvec2& c) const {
  if (empty()) return std::nullopt;
  std::array<std::size_t, 64> waiting{kRoot};  // one for each level, and fewer than 32 levels
  std::size_t count = 1;
  while (count > 0) {
    const std::size_t node = waiting[--count];
    const Node& found = nodes_[node];
    if (found.left == 0 || !may_be_left(a, b, found.box) || !may_be_left(b, c, found.box) ||
        !may_be_left(c, a, found.box)) {
      continue;
    }
    if (!is_leaf(node)) {
      waiting[count++] = 2 * node + 1;
      waiting[count++] = 2 * node;
      continue;
    }
    const std::size_t first = slots_of(node).first;
    for (std::size_t slot = first; slot < first + found.left; ++slot) {
      const glm::dvec2 p = points_[slots_[slot]];
      const bool inside =
          signed_area(a, b, p) >= 0.0 && signed_area(b, c, p) >= 0.0 && signed_area(c, a, p) >= 0.0;
      if (inside && p != a && p != b && p != c) return slots_[slot];
    }
  }
  return std::nullopt;
}

void CornerTree::remove(std::uint32_t corner) {
  std::size_t node = leaf_of_[corner];
  const std::size_t first = slots_of(node).first;
  const auto begin = slots_.begin() + static_cast<std::ptrdiff_t>(first);
  const auto last = begin + nodes_[node].left - 1;
  std::iter_swap(std::find(begin, last, corner), last);
  leaf_of_[corner] = kNoLeaf;
  for (; node >= kRoot; node /= 2) --nodes_[node].left;
}

}  // namespace beambench::scenes

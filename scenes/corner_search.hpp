#pragma once
// Finds the next corner for ear clipping, and a corner that blocks it, without examining all
// corners.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

namespace beambench::scenes {

/// Returns twice the signed area of a triangle, positive if it is counter-clockwise. Monotonic in
/// each coordinate of `c`, including rounding: it consists of differences, products with a constant
/// and a sum of two terms, each rounded to nearest.
inline double signed_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// A set of numbers in 0 ... size - 1. It has a bit for each number, a bit for each group of 64
/// numbers that states whether the group has a member, and so on. Each call takes O(log size).
class CornerSet {
 public:
  explicit CornerSet(std::uint32_t size);

  /// Inserts or removes a number.
  void assign(std::uint32_t number, bool member);
  /// Returns the first member from `number` on, wrapping around to 0, or nothing if the set is
  /// empty.
  std::optional<std::uint32_t> next(std::uint32_t number) const;

 private:
  std::optional<std::uint32_t> next_not_around(std::uint32_t number) const;

  struct Level {
    std::size_t first;  ///< index into words_
    std::size_t words;
  };
  std::vector<Level> levels_;
  std::vector<std::uint64_t> words_;
};

/// A k-d tree over points of the plane from which points are removed (Bentley 1975).
class CornerTree {
 public:
  /// `corners` are indices into `points`, which must outlive the tree.
  CornerTree(std::span<const glm::dvec2> points, std::vector<std::uint32_t> corners);

  bool empty() const { return nodes_.empty() || nodes_[kRoot].left == 0; }
  bool has(std::uint32_t corner) const { return !empty() && leaf_of_[corner] != kNoLeaf; }
  /// Returns a remaining corner that lies in the closed triangle, by the signs of `signed_area`,
  /// but does not coincide with one of the triangle's own corners. Returns nothing if there is
  /// none.
  std::optional<std::uint32_t> find_in_triangle(const glm::dvec2& a, const glm::dvec2& b,
                                                const glm::dvec2& c) const;
  /// Removes a corner that is in the tree.
  void remove(std::uint32_t corner);

 private:
  struct Rectangle {
    glm::dvec2 lower;
    glm::dvec2 upper;
  };
  struct Node {
    Rectangle box;           ///< box of all corners that were ever in the subtree
    std::uint32_t left = 0;  ///< corners remaining in the subtree; in a leaf, its first slots
  };
  static constexpr std::uint32_t kNoLeaf = 0;
  static constexpr std::size_t kRoot = 1;  ///< the children of node n are 2n and 2n + 1

  bool is_leaf(std::size_t node) const { return node >= nodes_.size() / 2; }
  /// Returns the contiguous slots of a node's corners: the first one, and the first after them.
  std::pair<std::size_t, std::size_t> slots_of(std::size_t node) const;
  void build(std::size_t node);

  std::span<const glm::dvec2> points_;
  std::vector<std::uint32_t> slots_;
  std::vector<std::uint32_t> leaf_of_;  ///< the leaf of each corner
  std::vector<Node> nodes_;             ///< the second half are leaves, a power of two of them
};

}  // namespace beambench::scenes

#pragma once
// Boxes for the builder: four floats at once, which every 64-bit processor supports.

#include <bit>
#include <cstdint>
#include <limits>

#include "scenes/bounds.hpp"

namespace beambench::accel::bvh {

/// Three coordinates; the fourth lane of a box or a center is ignored.
using Quad = float __attribute__((vector_size(16)));
using IntQuad = std::int32_t __attribute__((vector_size(16)));

inline Quad quad_of(const glm::vec3& v, float fourth = 0.0F) { return Quad{v.x, v.y, v.z, fourth}; }
inline Quad quad_of(float value) { return Quad{value, value, value, value}; }
inline Quad smaller(Quad a, Quad b) { return a < b ? a : b; }
inline Quad larger(Quad a, Quad b) { return a > b ? a : b; }

/// A box, possibly empty.
struct QuadBox {
  Quad lower;
  Quad upper;

  static QuadBox empty() {
    constexpr float kFar = std::numeric_limits<float>::infinity();
    return {quad_of(kFar), quad_of(-kFar)};
  }
  scenes::Bounds bounds() const {
    return {{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}};
  }
  void include(const QuadBox& other) {
    lower = smaller(other.lower, lower);
    upper = larger(other.upper, upper);
  }
  void include(Quad point) {
    lower = smaller(point, lower);
    upper = larger(point, upper);
  }
};

/// An item while it is sorted in place, so that its box stays close to its neighbors'.
class BuildItem {
 public:
  BuildItem(const scenes::Bounds& box, std::uint32_t index)
      : box_{quad_of(box.lower), quad_of(box.upper, std::bit_cast<float>(index))} {}

  const QuadBox& box() const { return box_; }
  std::uint32_t index() const { return std::bit_cast<std::uint32_t>(box_.upper[3]); }
  /// Returns twice the center, which saves a multiplication.
  Quad center() const {
    // The bits of an index are a subnormal number, which would slow down arithmetic.
    constexpr IntQuad kCoordinates{-1, -1, -1, 0};
    return box_.lower + std::bit_cast<Quad>(std::bit_cast<IntQuad>(box_.upper) & kCoordinates);
  }

 private:
  QuadBox box_;  ///< the fourth lane of `upper` holds the index
};

/// The boxes of some items, and the box of their centers.
struct BuildExtent {
  QuadBox boxes = QuadBox::empty();
  QuadBox centers = QuadBox::empty();

  void include(const BuildItem& item) {
    boxes.include(item.box());
    centers.include(item.center());
  }
  void include(const BuildExtent& other) {
    boxes.include(other.boxes);
    centers.include(other.centers);
  }
};

}  // namespace beambench::accel::bvh

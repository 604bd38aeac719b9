#pragma once
// The positions where primitives begin and end along an axis: the candidates for splitting planes.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace beambench::accel::kd_tree {

/// A float as an integer with the same order, so that planes are compared and sorted as integers.
class PlaneKey {
 public:
  explicit PlaneKey(float plane) {
    const auto bits = std::bit_cast<std::uint32_t>(plane + 0.0F);  // -0 becomes 0
    key_ = (bits & kSign) != 0 ? ~bits : bits | kSign;
  }
  static PlaneKey from_bits(std::uint32_t bits) { return PlaneKey(bits); }

  std::uint32_t bits() const { return key_; }
  float plane() const { return std::bit_cast<float>((key_ & kSign) != 0 ? key_ & ~kSign : ~key_); }

 private:
  explicit PlaneKey(std::uint32_t key) : key_(key) {}

  static constexpr std::uint32_t kSign = 1U << 31U;
  std::uint32_t key_;
};

/// An event of the sweep (Wald and Havran, "On building fast kd-trees for ray tracing, and on doing
/// that in O(N log N)", 2006, section 4.2): an item begins or ends at a plane. An event is stored
/// as one integer, so that events are ordered as in the sweep: by plane, ends before beginnings,
/// then by item. Planar events do not occur: boxes are widened, so each item ends strictly above
/// its beginning.
class SplitEvent {
 public:
  static constexpr std::uint32_t kItems = 1U << 31U;  ///< one more than the largest index

  SplitEvent() = default;
  static SplitEvent begin(float plane, std::uint32_t item) {
    return SplitEvent(PlaneKey(plane), kBegin | item);
  }
  static SplitEvent end(float plane, std::uint32_t item) {
    return SplitEvent(PlaneKey(plane), item);
  }

  bool is_begin() const { return (bits_ & kBegin) != 0; }
  PlaneKey plane() const { return PlaneKey::from_bits(static_cast<std::uint32_t>(bits_ >> 32U)); }
  std::uint32_t item() const { return static_cast<std::uint32_t>(bits_) & (kItems - 1); }
  std::uint64_t bits() const { return bits_; }
  friend bool operator<(SplitEvent a, SplitEvent b) { return a.bits_ < b.bits_; }

 private:
  SplitEvent(PlaneKey plane, std::uint32_t rest)
      : bits_(std::uint64_t{plane.bits()} << 32U | rest) {}

  static constexpr std::uint64_t kBegin = 1U << 31U;
  std::uint64_t bits_;
};

/// Sorts events; `scratch` must have the same size. Events with the same plane and kind must be in
/// the order of their items.
void sort_events(std::span<SplitEvent> events, std::span<SplitEvent> scratch);

}  // namespace beambench::accel::kd_tree

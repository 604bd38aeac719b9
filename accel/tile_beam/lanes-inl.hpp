// Types and functions over Highway for the kernels of tile beams, for the instruction set being
// compiled.

#if defined(ACCEL_TILE_BEAM_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_LANES_INL
#undef ACCEL_TILE_BEAM_LANES_INL
#else
#define ACCEL_TILE_BEAM_LANES_INL
#endif

#include <array>
#include <bit>
#include <cstddef>

#include <hwy/highway.h>

#include "accel/core/compress-inl.hpp"
#include "accel/core/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace accel::HWY_NAMESPACE;

/// Returns the lane of the largest of several values.
template <std::size_t kValues>
HWY_INLINE std::size_t largest_of(const std::array<float, kValues>& values, LaneBits lanes) {
  auto largest = static_cast<std::size_t>(std::countr_zero(lanes));
  for (lanes &= lanes - 1; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    if (values[lane] > values[largest]) largest = lane;
  }
  return largest;
}

/// Looks up entries of a table of 32 floats by index.
class Table32 {
 public:
  HWY_INLINE explicit Table32(const float* entries) : entries_(entries) {}

  HWY_INLINE Floats at(Ints indices) const {
    if constexpr (kLanes == 16) {  // two permutations are faster than a gather
      const auto picked = hn::IndicesFromVec(Tag(), hn::And(indices, hn::Set(IntTag(), 15)));
      const Floats low = hn::TableLookupLanes(load(entries_), picked);
      const Floats high = hn::TableLookupLanes(load(entries_ + 16), picked);
      return hn::IfThenElse(hn::RebindMask(Tag(), hn::Gt(indices, hn::Set(IntTag(), 15))), high,
                            low);
    } else {
      return hn::GatherIndex(Tag(), entries_, indices);
    }
  }

 private:
  const float* entries_;
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

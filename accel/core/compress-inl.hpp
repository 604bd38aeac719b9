// Moves the lanes of a mask to the front of a register, for the instruction set being compiled.

#if defined(ACCEL_CORE_COMPRESS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_CORE_COMPRESS_INL
#undef ACCEL_CORE_COMPRESS_INL
#else
#define ACCEL_CORE_COMPRESS_INL
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// For each eight-bit mask, the indices of its lanes, four bits each, the first in the lowest bits.
inline constexpr std::array<std::uint32_t, 256> kLanesOfMask = [] {
  std::array<std::uint32_t, 256> lanes{};
  for (std::uint32_t mask = 0; mask < 256; ++mask) {
    std::uint32_t shift = 0;
    for (std::uint32_t lane = 0; lane < 8; ++lane) {
      if ((mask >> lane & 1U) == 0) continue;
      lanes[mask] |= lane << shift;
      shift += 4;
    }
  }
  return lanes;
}();

/// Returns the values in the lanes of a mask consecutively, followed by unspecified values; for
/// four-byte lanes. Highway's Compress is one instruction on AVX-512. Elsewhere, Highway 1.0.3
/// compiled by GCC copies Compress's 1 KiB table to the stack on every call, which took a third of
/// the total time.
template <class D>
HWY_INLINE hn::Vec<D> compress([[maybe_unused]] D d, hn::Vec<D> values, hn::Mask<D> mask) {
  static_assert(sizeof(hn::TFromD<D>) == 4);
#if HWY_TARGET == HWY_AVX2
  if constexpr (hn::MaxLanes(D()) == 8) {
    const hn::RebindToUnsigned<D> numbers;
    std::array<std::uint8_t, 8> bits;
    hn::StoreMaskBits(d, mask, bits.data());
    const auto packed = hn::Set(numbers, kLanesOfMask[bits[0]]);
    const auto lanes = hn::Shr(packed, hn::ShiftLeft<2>(hn::Iota(numbers, 0)));
    return hn::TableLookupLanes(values, hn::IndicesFromVec(d, hn::And(lanes, hn::Set(numbers, 7))));
  }
#endif
  return hn::Compress(values, mask);
}

}  // namespace beambench::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

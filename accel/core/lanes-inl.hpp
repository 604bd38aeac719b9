// Types and functions over Highway for the kernels, for the instruction set being compiled.

#if defined(ACCEL_CORE_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_CORE_LANES_INL
#undef ACCEL_CORE_LANES_INL
#else
#define ACCEL_CORE_LANES_INL
#endif

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <hwy/highway.h>

#include "accel/core/compress-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Sixteen lanes if a register has that many; otherwise fewer, and sixteen values take several
/// registers.
using Tag = hn::CappedTag<float, 16>;
using Floats = hn::Vec<Tag>;
using Mask = hn::Mask<Tag>;
using IntTag = hn::RebindToSigned<Tag>;
using Ints = hn::Vec<IntTag>;
inline constexpr std::size_t kLanes = HWY_LANES(float) < 16 ? HWY_LANES(float) : 16;

/// One bit per lane.
using LaneBits = std::uint32_t;

HWY_INLINE Floats all(float value) { return hn::Set(Tag(), value); }
HWY_INLINE Floats load(const float* from) { return hn::Load(Tag(), from); }
HWY_INLINE void store(Floats values, float* to) { hn::Store(values, Tag(), to); }

/// A word as large as a mask in memory, so that a store can be forwarded to a load.
using MaskWord = std::conditional_t<(kLanes > 8), std::uint16_t, std::uint8_t>;
static_assert(kLanes <= 8 || std::endian::native == std::endian::little);

HWY_INLINE LaneBits bits_of(Mask mask) {
  MaskWord word;
  hn::StoreMaskBits(Tag(), mask, reinterpret_cast<std::uint8_t*>(&word));
  return word;
}
HWY_INLINE Mask mask_of(LaneBits bits) {
  const auto word = static_cast<MaskWord>(bits);
  return hn::LoadMaskBits(Tag(), reinterpret_cast<const std::uint8_t*>(&word));
}

/// Stores the values in the lanes of `mask` consecutively, followed by arbitrary values: there must
/// be room for a whole register. Returns the number of values. Compressing directly to memory, as
/// Highway's CompressStore does on AVX-512, is slow on some processors (AMD Zen 4).
template <class D>
HWY_INLINE std::size_t compress_store(D d, hn::Vec<D> values, hn::Mask<D> mask, hn::TFromD<D>* to) {
  hn::StoreU(compress(d, values, mask), d, to);
  return hn::CountTrue(d, mask);
}

/// Returns 1 / values, accurate to two roundings; infinity for 0 and 0 for infinity.
template <class D>
HWY_INLINE hn::Vec<D> reciprocal(D d, hn::Vec<D> values) {
#if HWY_ARCH_X86 && HWY_MAX_BYTES == 64  // a Newton step is faster than a division
  const auto about = hn::ApproximateReciprocal(values);
  const auto rest = hn::NegMulAdd(about, values, hn::Set(d, 1.0F));
  // If the estimate or the value is 0 or infinite, the estimate is exact. The rest is then NaN or
  // -inf and fails the comparison with -1; otherwise the rest is nearly 0.
  return hn::IfThenElse(hn::Gt(rest, hn::Set(d, -1.0F)), hn::MulAdd(about, rest, about), about);
#else
  return hn::Div(hn::Set(d, 1.0F), values);
#endif
}
HWY_INLINE Floats reciprocal(Floats values) { return reciprocal(Tag(), values); }

/// Calls `test(lane)` for the first lane of each register and combines the masks it returns.
template <class Test>
HWY_INLINE LaneBits for_each_register(Test test) {
  LaneBits bits = 0;
  for (std::size_t lane = 0; lane < 16; lane += kLanes) bits |= bits_of(test(lane)) << lane;
  return bits;
}

/// Three coordinates per lane.
struct Points {
  Floats x;
  Floats y;
  Floats z;
};

/// Returns x * a.x + y * a.y + z * a.z.
HWY_INLINE Floats dot(const Points& a, const Points& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
template <class Vector>
HWY_INLINE Points all_of(const Vector& v) {
  return {all(v.x), all(v.y), all(v.z)};
}

}  // namespace beambench::accel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

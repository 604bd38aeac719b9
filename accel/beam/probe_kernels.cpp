// The probes of primitive_image.hpp, compiled for several instruction sets.

#include <array>

#include "accel/beam/primitive_image.hpp"

// Highway includes this file again for each instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "accel/beam/probe_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::beam::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Lanes for as many samples as a register holds.
using AllLanes = hn::CappedTag<float, 16>;
/// One sample at a time: scalar code with the arithmetic of `AllLanes`, including fused operations,
/// so that the same samples pass.
using OneLane = hn::CappedTag<float, 1>;

/// Combines the masks that `test(x, y, inverse_t)` returns for each register of samples.
template <class Tag, class Test>
SampleMask for_each_register(const SampleBatch& batch, Test test) {
  const Tag tag;
  SampleMask bits = 0;
  for (std::size_t i = 0; i < batch.size; i += hn::Lanes(tag)) {
    const auto mask = test(hn::Load(tag, &batch.x[i]), hn::Load(tag, &batch.y[i]),
                           hn::Load(tag, &batch.inverse_t[i]));
    std::array<std::uint8_t, 8> stored{};
    hn::StoreMaskBits(tag, mask, stored.data());
    bits |= (static_cast<SampleMask>(stored[0]) | static_cast<SampleMask>(stored[1]) << 8U) << i;
  }
  return bits & all_samples(batch);
}

template <class Tag, class Floats = hn::Vec<Tag>>
Floats at(Tag tag, const PixelLine& line, Floats x, Floats y) {
  return hn::MulAdd(hn::Set(tag, line.x), x,
                    hn::MulAdd(hn::Set(tag, line.y), y, hn::Set(tag, line.constant)));
}

template <class Tag>
SampleMask probe_triangles(std::span<const TriangleImage> images, const SampleBatch& batch) {
  using Floats = hn::Vec<Tag>;
  const Tag tag;
  SampleMask bits = 0;
  for (const TriangleImage& image : images) {
    bits |= for_each_register<Tag>(batch, [&](Floats x, Floats y, Floats inverse_t) {
      const auto& edges = image.edges;
      const Floats nearest_edge = hn::Min(
          at(tag, edges[0], x, y), hn::Min(at(tag, edges[1], x, y), at(tag, edges[2], x, y)));
      return hn::And(hn::Ge(nearest_edge, hn::Zero(tag)),
                     hn::Ge(at(tag, image.inverse_t, x, y), inverse_t));
    });
  }
  return bits;
}

template <class Tag>
SampleMask probe_sphere(const SphereImage& image, const SampleBatch& batch) {
  using Floats = hn::Vec<Tag>;
  const Tag tag;
  return for_each_register<Tag>(batch, [&](Floats x, Floats y, Floats) {
    const Floats u = hn::Sub(x, hn::Set(tag, image.center_x));
    const Floats v = hn::Sub(y, hn::Set(tag, image.center_y));
    const Floats by_u = hn::MulAdd(hn::Set(tag, image.xx), u,
                                   hn::MulAdd(hn::Set(tag, image.xy), v, hn::Set(tag, image.x)));
    const Floats by_v = hn::MulAdd(hn::Set(tag, image.yy), v, hn::Set(tag, image.y));
    const Floats value = hn::MulAdd(by_u, u, hn::MulAdd(by_v, v, hn::Set(tag, image.constant)));
    return hn::Ge(value, hn::Zero(tag));
  });
}

template <class Tag>
const ProbeKernels& kernels_with() {
  static constexpr ProbeKernels kKernels{probe_triangles<Tag>, probe_sphere<Tag>, HWY_TARGET};
  return kKernels;
}

const ProbeKernels& simd_kernels() { return kernels_with<AllLanes>(); }
const ProbeKernels& scalar_kernels() { return kernels_with<OneLane>(); }

}  // namespace beambench::accel::beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace beambench::accel::beam {

HWY_EXPORT(simd_kernels);
HWY_EXPORT(scalar_kernels);

const ProbeKernels& simd_probe_kernels() { return HWY_DYNAMIC_DISPATCH(simd_kernels)(); }
const ProbeKernels& scalar_probe_kernels() { return HWY_DYNAMIC_DISPATCH(scalar_kernels)(); }

}  // namespace beambench::accel::beam
#endif

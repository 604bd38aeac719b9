// Finds the rays of a list that come from one square of pixels.

#if defined(ACCEL_TILE_BEAM_RASTER_SAMPLES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_RASTER_SAMPLES_INL
#undef ACCEL_TILE_BEAM_RASTER_SAMPLES_INL
#else
#define ACCEL_TILE_BEAM_RASTER_SAMPLES_INL
#endif

#include <algorithm>
#include <bit>

#include "accel/tile_beam/lanes-inl.hpp"
#include "accel/tile_beam/pencil_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Returns how many of up to `most` consecutive rays come from one square of 4 x 4 pixels; at least
/// 1.
HWY_INLINE std::size_t run_in_square(const PencilSamples& samples, std::size_t from,
                                     std::size_t most) {
  const std::uint32_t sample = samples.of_rays[from];
  const std::uint32_t pixel = samples.per_pixel == 1 ? sample : sample / samples.per_pixel;
  const std::uint32_t y = samples.row_of(pixel);
  const std::uint32_t x = pixel - y * samples.width;
  // In each row of the square, the samples are consecutive.
  const std::uint32_t row = samples.width * samples.per_pixel;
  const std::uint32_t corner = (y & ~3U) * row + (x & ~3U) * samples.per_pixel;
  const std::uint32_t across = std::min(4U, samples.width - (x & ~3U)) * samples.per_pixel;
  const hn::RebindToUnsigned<Tag> d;
  const auto from_corner = [&](std::size_t i) {
    return hn::Sub(hn::LoadU(d, &samples.of_rays[from + i]), hn::Set(d, corner));
  };
  const auto inside = [&](auto offset) {
    const auto in_row = [&](std::uint32_t k) {
      return hn::Lt(hn::Sub(offset, hn::Set(d, k * row)), hn::Set(d, across));
    };
    return hn::Or(hn::Or(in_row(0), in_row(1)), hn::Or(in_row(2), in_row(3)));
  };
  std::size_t run = 0;
  // Whole registers first, then one by one at the end of the list.
  for (; run < most && from + run + kLanes <= samples.of_rays.size(); run += kLanes) {
    const LaneBits here = bits_of(hn::RebindMask(Tag(), inside(from_corner(run))));
    const auto count = static_cast<std::size_t>(std::countr_one(here));
    if (count < kLanes) return std::min(run + count, most);
  }
  for (; run < most; ++run) {
    const std::uint32_t offset = samples.of_rays[from + run] - corner;
    bool in = false;
    for (std::uint32_t k = 0; k < 4; ++k) in = in || offset - k * row < across;
    if (!in) break;
  }
  return std::min(run, most);
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

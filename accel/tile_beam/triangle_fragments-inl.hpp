// The smallest triangles: each lane walks through the samples of its own.

#if defined(ACCEL_TILE_BEAM_TRIANGLE_FRAGMENTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_TRIANGLE_FRAGMENTS_INL
#undef ACCEL_TILE_BEAM_TRIANGLE_FRAGMENTS_INL
#else
#define ACCEL_TILE_BEAM_TRIANGLE_FRAGMENTS_INL
#endif

#include "accel/tile_beam/tile_raster-inl.hpp"
#include "accel/tile_beam/triangle_setup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::HWY_NAMESPACE {

/// Triangles with no more samples than this in their box are drawn by lanes.
inline constexpr float kMostLaneSamples = 9.0F;

/// Hits found by lanes, before they are compared with the tile's.
struct Fragments {
  static constexpr std::size_t kMost = 16 * 9 + 16;  // room for a whole register at the end

  alignas(64) std::array<std::int32_t, kMost> place;
  alignas(64) std::array<float, kMost> inverse_t;
  alignas(64) std::array<std::int32_t, kMost> triangle;
  std::size_t count;
};

/// Each lane walks through its triangle's box, row by row.
HWY_INLINE void collect_fragments(const TriangleImages& images, Mask small, Fragments& fragments) {
  const Floats one = all(1.0F);
  const Ints triangle = hn::Iota(IntTag(), 0);
  Floats i = images.left;
  Floats j = images.top;
  fragments.count = 0;
  do {
    const Floats edge =
        hn::Min(images.edge0.at(i, j), hn::Min(images.edge1.at(i, j), images.edge2.at(i, j)));
    const Mask hit = hn::And(small, hn::Ge(edge, hn::Zero(Tag())));
    const Ints x = hn::ConvertTo(IntTag(), i);
    const Ints y = hn::ConvertTo(IntTag(), j);
    const Ints three = hn::Set(IntTag(), 3);
    const Ints row = hn::Or(hn::ShiftLeft<TileImage::kWidthBits>(hn::AndNot(three, y)),
                            hn::ShiftLeft<2>(hn::And(y, three)));
    const Ints place =
        hn::Add(row, hn::Or(hn::ShiftLeft<2>(hn::AndNot(three, x)), hn::And(x, three)));
    const auto keep = hn::RebindMask(IntTag(), hit);
    hn::CompressStore(place, keep, IntTag(), fragments.place.data() + fragments.count);
    hn::CompressStore(triangle, keep, IntTag(), fragments.triangle.data() + fragments.count);
    fragments.count += hn::CompressStore(images.plane.at(i, j), hit, Tag(),
                                         fragments.inverse_t.data() + fragments.count);
    i = hn::Add(i, one);
    const Mask row_ends = hn::Gt(i, images.right);
    i = hn::IfThenElse(row_ends, images.left, i);
    j = hn::Add(j, hn::IfThenElseZero(row_ends, one));
    small = hn::And(small, hn::Le(j, images.bottom));
  } while (!hn::AllFalse(Tag(), small));
}

HWY_INLINE void resolve_fragments(const Fragments& fragments, const PrimitiveId* primitives,
                                  TileImage& image) {
  for (std::size_t f = 0; f < fragments.count; ++f) {
    const auto at = static_cast<std::size_t>(fragments.place[f]);
    if (fragments.inverse_t[f] > image.inverse_t[at]) {
      image.inverse_t[at] = fragments.inverse_t[f];
      image.primitive[at] = primitives[fragments.triangle[f]];
    }
  }
}

}  // namespace beambench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

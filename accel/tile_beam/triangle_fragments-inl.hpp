// Draws the smallest triangles: each lane walks through the samples of its own triangle.

#if defined(ACCEL_TILE_BEAM_TRIANGLE_FRAGMENTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_TRIANGLE_FRAGMENTS_INL
#undef ACCEL_TILE_BEAM_TRIANGLE_FRAGMENTS_INL
#else
#define ACCEL_TILE_BEAM_TRIANGLE_FRAGMENTS_INL
#endif

#include "accel/tile_beam/tile_raster-inl.hpp"
#include "accel/tile_beam/triangle_setup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Triangles with at most this many samples in their box are drawn one per lane.
inline constexpr float kMaxLaneSamples = 9.0F;

/// Hits found by lanes, before the depth test.
struct Fragments {
  static constexpr std::size_t kMaxCount = 16 * 9 + 16;  // room for a whole register at the end

  /// The sample's number in the tile, row by row, with the triangle's lane in the lowest four bits.
  alignas(64) std::array<std::int32_t, kMaxCount> where;
  alignas(64) std::array<float, kMaxCount> inverse_t;
  std::size_t count;
};

/// Collects the hits of small triangles; each lane walks through its triangle's box, row by row.
HWY_INLINE void collect_fragments(const TriangleImages& images, Mask small, Fragments& fragments) {
  const Floats one = all(1.0F);
  Floats i = images.left;
  Floats j = images.top;
  const auto whole = [](Floats samples) { return hn::ConvertTo(IntTag(), samples); };
  Ints where = hn::Add(hn::ShiftLeft<4 + TileImage::kWidthBits>(whole(j)),
                       hn::Add(hn::ShiftLeft<4>(whole(i)), hn::Iota(IntTag(), 0)));
  // From the sample after a row's last one to the next row's first one.
  const Ints to_next_row =
      hn::ShiftLeft<4>(whole(hn::Sub(all(kTileWidth - 1.0F), hn::Sub(images.right, images.left))));
  fragments.count = 0;
  do {
    const Floats edge =
        hn::Min(images.edge0.at(i, j), hn::Min(images.edge1.at(i, j), images.edge2.at(i, j)));
    const Mask hit = hn::And(small, hn::Ge(edge, hn::Zero(Tag())));
    compress_store(IntTag(), where, hn::RebindMask(IntTag(), hit),
                   fragments.where.data() + fragments.count);
    fragments.count += compress_store(Tag(), images.plane.at(i, j), hit,
                                      fragments.inverse_t.data() + fragments.count);
    i = hn::Add(i, one);
    const Mask row_ends = hn::Gt(i, images.right);
    where = hn::Add(hn::Add(where, hn::Set(IntTag(), 16)),
                    hn::IfThenElseZero(hn::RebindMask(IntTag(), row_ends), to_next_row));
    i = hn::IfThenElse(row_ends, images.left, i);
    j = hn::Add(j, hn::IfThenElseZero(row_ends, one));
    small = hn::And(small, hn::Le(j, images.bottom));
  } while (!hn::AllFalse(Tag(), small));
}

HWY_INLINE void resolve_fragments(const Fragments& fragments, const scenes::PrimitiveId* primitives,
                                  TileImage& image) {
  for (std::size_t f = 0; f < fragments.count; ++f) {
    const auto where = static_cast<unsigned>(fragments.where[f]);
    const std::size_t at = TileImage::place(static_cast<int>(where >> 4U & (kTileWidth - 1U)),
                                            static_cast<int>(where >> (4 + TileImage::kWidthBits)));
    // Avoids a branch, which would be unpredictable.
    const bool nearer = fragments.inverse_t[f] > image.inverse_t[at];
    image.inverse_t[at] = nearer ? fragments.inverse_t[f] : image.inverse_t[at];
    image.primitive[at] = nearer ? primitives[where & 15U] : image.primitive[at];
  }
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

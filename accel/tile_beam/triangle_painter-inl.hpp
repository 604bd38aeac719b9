// Draws large triangles one by one, in rows of blocks.

#if defined(ACCEL_TILE_BEAM_TRIANGLE_PAINTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_TRIANGLE_PAINTER_INL
#undef ACCEL_TILE_BEAM_TRIANGLE_PAINTER_INL
#else
#define ACCEL_TILE_BEAM_TRIANGLE_PAINTER_INL
#endif

#include "accel/tile_beam/row_ends-inl.hpp"
#include "accel/tile_beam/tile_raster-inl.hpp"
#include "accel/tile_beam/triangle_setup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Draws one triangle by blocks.
class BlockPainter {
 public:
  BlockPainter(const std::array<TileLine, 3>& edges, const TileLine& plane,
               scenes::PrimitiveId primitive, const SampleRectangle& box)
      : edges_(edges), plane_(plane), primitive_(primitive), box_(box) {}

  /// Paints all blocks of the box that the triangle may meet; with `kClip`, not beyond the box.
  template <bool kClip>
  HWY_INLINE void paint(TileImage& image) const {
    const int last_row = box_.bottom >> 2;
    const RowEnds ends(edges_, box_.left >> 2, box_.right >> 2);
    for (int row = box_.top >> 2; row <= last_row; ++row) {
      paint_row<kClip>(image, row, ends.first(row), ends.last(row));
    }
  }

 private:
  template <bool kClip>
  HWY_INLINE void paint_row(TileImage& image, int row, int first_column, int last_column) const {
    for (std::size_t first = 0; first < TileImage::kBlockSamples; first += kLanes) {
      const Floats j = hn::Add(block_y(first), all(static_cast<float>(4 * row)));
      const Floats edge0 = hn::MulAdd(all(edges_[0].y), j, all(edges_[0].constant));
      const Floats edge1 = hn::MulAdd(all(edges_[1].y), j, all(edges_[1].constant));
      const Floats edge2 = hn::MulAdd(all(edges_[2].y), j, all(edges_[2].constant));
      const Floats plane = hn::MulAdd(all(plane_.y), j, all(plane_.constant));
      Floats i = hn::Add(block_x(first), all(static_cast<float>(4 * first_column)));
      std::size_t at = TileImage::block(first_column, row) + first;
      for (int column = first_column; column <= last_column; ++column) {
        const Floats edge = hn::Min(hn::MulAdd(all(edges_[0].x), i, edge0),
                                    hn::Min(hn::MulAdd(all(edges_[1].x), i, edge1),
                                            hn::MulAdd(all(edges_[2].x), i, edge2)));
        Mask hit = hn::Ge(edge, hn::Zero(Tag()));
        if constexpr (kClip) hit = hn::And(hit, in_box(i, j));
        keep_nearer(image, at, hn::MulAdd(all(plane_.x), i, plane), hit, primitive_);
        i = hn::Add(i, all(4.0F));
        at += TileImage::kBlockSamples;
      }
    }
  }

  HWY_INLINE Mask in_box(Floats i, Floats j) const {
    const auto within = [](Floats value, std::uint8_t low, std::uint8_t high) {
      return hn::And(hn::Ge(value, all(low)), hn::Le(value, all(high)));
    };
    return hn::And(within(i, box_.left, box_.right), within(j, box_.top, box_.bottom));
  }

  std::array<TileLine, 3> edges_;
  TileLine plane_;
  scenes::PrimitiveId primitive_;
  SampleRectangle box_;
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// Large triangles, one by one: rows of blocks.

#if defined(ACCEL_TILE_BEAM_TRIANGLE_PAINTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_TRIANGLE_PAINTER_INL
#undef ACCEL_TILE_BEAM_TRIANGLE_PAINTER_INL
#else
#define ACCEL_TILE_BEAM_TRIANGLE_PAINTER_INL
#endif

#include <algorithm>

#include "accel/tile_beam/exact_triangle.hpp"
#include "accel/tile_beam/tile_raster-inl.hpp"
#include "accel/tile_beam/triangle_setup-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::HWY_NAMESPACE {

/// Draws one triangle by blocks.
class BlockPainter {
 public:
  BlockPainter(const std::array<TileLine, 3>& edges, const TileLine& plane, PrimitiveId primitive,
               const SampleRectangle& box)
      : edges_(edges), plane_(plane), primitive_(primitive), box_(box) {}

  /// Paints all blocks of the box that the triangle may meet; `clip`: not beyond the box.
  template <bool kClip>
  HWY_INLINE void paint(TileImage& image) const {
    const int last_row = box_.bottom >> 2;
    for (int row = box_.top >> 2; row <= last_row; ++row) {
      int first = box_.left >> 2;
      int last = box_.right >> 2;
      if (last - first >= 3) narrow(row, first, last);
      if (first <= last) paint_row<kClip>(image, row, first, last);
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

  /// Leaves out the blocks at a row's ends that lie outside an edge.
  HWY_INLINE void narrow(int row, int& first, int& last) const {
    auto low = static_cast<float>(4 * first);
    auto high = static_cast<float>(4 * last + 3);
    const auto top = static_cast<float>(4 * row);
    for (const TileLine& edge : edges_) {
      // The largest value on a column of the block.
      const float value = edge.constant + edge.y * (edge.y > 0.0F ? top + 3.0F : top);
      constexpr float kSlack = 0.0625F;
      if (edge.x > 0.0F) {
        low = std::max(low, -value / edge.x - kSlack);
      } else if (edge.x < 0.0F) {
        high = std::min(high, -value / edge.x + kSlack);
      }
    }
    first = std::max(first, static_cast<int>(std::min(low, 1e6F)) >> 2);
    last = high < 0.0F ? -1 : std::min(last, static_cast<int>(high) >> 2);
  }

  std::array<TileLine, 3> edges_;
  TileLine plane_;
  PrimitiveId primitive_;
  SampleRectangle box_;
};

}  // namespace beambench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

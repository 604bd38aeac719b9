// Drawing triangles into a tile: the smallest by lanes that walk their own samples, larger ones by
// blocks.

#if defined(ACCEL_TILE_BEAM_TRIANGLE_RASTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_TRIANGLE_RASTER_INL
#undef ACCEL_TILE_BEAM_TRIANGLE_RASTER_INL
#else
#define ACCEL_TILE_BEAM_TRIANGLE_RASTER_INL
#endif

#include <algorithm>
#include <bit>
#include <cmath>

#include "accel/tile_beam/exact_triangle.hpp"
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
    static_assert(kTileWidth == 64);
    const Ints row =
        hn::Or(hn::ShiftLeft<6>(hn::AndNot(three, y)), hn::ShiftLeft<2>(hn::And(y, three)));
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

/// Triangles' images, to be taken one by one.
struct StoredImages {
  alignas(64) std::array<std::array<float, kLanes>, 12> lines;
  alignas(64) std::array<std::array<float, kLanes>, 4> box;

  HWY_INLINE explicit StoredImages(const TriangleImages& images) {
    const std::array<const Lines*, 4> all_lines{&images.edge0, &images.edge1, &images.edge2,
                                                &images.plane};
    for (std::size_t line = 0; line < 4; ++line) {
      store(all_lines[line]->x, lines[3 * line].data());
      store(all_lines[line]->y, lines[3 * line + 1].data());
      store(all_lines[line]->constant, lines[3 * line + 2].data());
    }
    store(images.left, box[0].data());
    store(images.right, box[1].data());
    store(images.top, box[2].data());
    store(images.bottom, box[3].data());
  }

  HWY_INLINE TileLine line(std::size_t which, std::size_t lane) const {
    return {lines[3 * which][lane], lines[3 * which + 1][lane], lines[3 * which + 2][lane]};
  }
  HWY_INLINE SampleRectangle rectangle(std::size_t lane) const {
    const auto side = [&](std::size_t which) {
      return static_cast<std::uint8_t>(static_cast<int>(box[which][lane]));
    };
    return {side(0), side(1), side(2), side(3)};
  }
};

inline void paint_exact(const Meshlet& meshlet, std::size_t triangle, const TileView& view,
                        TileImage& image) {
  const auto exact = exact_triangle(view, {meshlet.corner(0, triangle), meshlet.corner(1, triangle),
                                           meshlet.corner(2, triangle)});
  if (!exact) return;
  BlockPainter(exact->edges, exact->plane, meshlet.primitives[triangle], exact->box)
      .paint<true>(image);
}

/// Draws a meshlet. What lies behind `farthest` (1/t) is not drawn.
inline void draw_meshlet(const Meshlet& meshlet, const TileView& view, float farthest,
                         TileImage& image) {
  SeenVertices seen;
  see_vertices(meshlet, view, seen);
  for (std::size_t first = 0; first < meshlet.triangle_count; first += kLanes) {
    const TriangleImages images = see_triangles(meshlet, seen, first, view, farthest);
    for (LaneBits exact = bits_of(images.needs_exact); exact != 0; exact &= exact - 1) {
      paint_exact(meshlet, first + static_cast<std::size_t>(std::countr_zero(exact)), view, image);
    }
    if (hn::AllFalse(Tag(), images.drawn)) continue;
    const PrimitiveId* primitives = meshlet.primitives.data() + first;

    const Floats one = all(1.0F);
    const Floats samples = hn::Mul(hn::Add(hn::Sub(images.right, images.left), one),
                                   hn::Add(hn::Sub(images.bottom, images.top), one));
    const Mask small = hn::And(images.drawn, hn::Le(samples, all(kMostLaneSamples)));
    if (!hn::AllFalse(Tag(), small)) {
      Fragments fragments;
      collect_fragments(images, small, fragments);
      resolve_fragments(fragments, primitives, image);
    }
    LaneBits large = bits_of(hn::AndNot(small, images.drawn));
    if (large == 0) continue;
    const StoredImages stored(images);
    const LaneBits acute = bits_of(images.acute);
    for (; large != 0; large &= large - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(large));
      const BlockPainter painter({stored.line(0, lane), stored.line(1, lane), stored.line(2, lane)},
                                 stored.line(3, lane), primitives[lane], stored.rectangle(lane));
      if ((acute >> lane & 1U) != 0) {
        painter.paint<true>(image);
      } else {
        painter.paint<false>(image);
      }
    }
  }
}

}  // namespace beambench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

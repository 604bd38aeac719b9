// Drawing a meshlet into a tile: each of its triangles in the way that suits its size.

#if defined(ACCEL_TILE_BEAM_MESHLET_RASTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_MESHLET_RASTER_INL
#undef ACCEL_TILE_BEAM_MESHLET_RASTER_INL
#else
#define ACCEL_TILE_BEAM_MESHLET_RASTER_INL
#endif

#include <bit>

#include "accel/tile_beam/exact_triangle.hpp"
#include "accel/tile_beam/triangle_blocks-inl.hpp"
#include "accel/tile_beam/triangle_fragments-inl.hpp"
#include "accel/tile_beam/triangle_painter-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::HWY_NAMESPACE {

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
    const Mask rest = hn::AndNot(small, images.drawn);
    if (hn::AllFalse(Tag(), rest)) continue;
    const StoredImages stored(images);
    const BlockBoxes boxes(images);
    const Mask few = hn::And(rest, hn::Le(boxes.count(), all(kMostListedBlocks)));
    const Mask listed = hn::AndNot(images.acute, few);
    if (!hn::AllFalse(Tag(), listed)) {
      BlockList list;
      list_blocks(images, boxes, listed, list);
      paint_list(list, stored, primitives, image);
    }
    const LaneBits acute = bits_of(images.acute);
    for (LaneBits left = bits_of(hn::AndNot(listed, rest)); left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
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

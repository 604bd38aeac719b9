// Draws a meshlet into a tile, each of its triangles by the method for its size.

#if defined(ACCEL_TILE_BEAM_MESHLET_RASTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_MESHLET_RASTER_INL
#undef ACCEL_TILE_BEAM_MESHLET_RASTER_INL
#else
#define ACCEL_TILE_BEAM_MESHLET_RASTER_INL
#endif

#include <bit>

#include "accel/core/intersect_triangle.hpp"
#include "accel/tile_beam/exact_triangle.hpp"
#include "accel/tile_beam/ray_raster-inl.hpp"
#include "accel/tile_beam/triangle_blocks-inl.hpp"
#include "accel/tile_beam/triangle_fragments-inl.hpp"
#include "accel/tile_beam/triangle_painter-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Draws triangles that need double precision, one by one. `triangle_of(lane)` is the index of a
/// lane's triangle.
template <class TriangleOf>
inline void draw_exactly(const Meshlet& meshlet, TriangleOf triangle_of, Mask which,
                         const TileRays& rays, TileImage& image) {
  for (LaneBits left = bits_of(which); left != 0; left &= left - 1) {
    const std::size_t triangle = triangle_of(static_cast<std::size_t>(std::countr_zero(left)));
    const std::array<glm::vec3, 3> corners{meshlet.corner(0, triangle), meshlet.corner(1, triangle),
                                           meshlet.corner(2, triangle)};
    const auto exact = exact_triangle(rays.view, corners);
    if (!exact) continue;
    if (exact->at_eye) {
      draw_by_rays(rays, exact->box, kNearestOfAll, meshlet.primitives[triangle], image,
                   [&](const CanonicalRay& ray) {
                     return intersect_triangle(ray, corners[0], corners[1], corners[2]);
                   });
    } else {
      BlockPainter(exact->edges, exact->plane, meshlet.primitives[triangle], exact->box)
          .paint<true>(image);
    }
  }
}

/// Draws large triangles one by one, row by row; acute ones are clipped to their boxes.
inline void draw_large(const StoredImages& images, const scenes::PrimitiveId* primitives,
                       Mask which, Mask acute_ones, TileImage& image) {
  const LaneBits acute = bits_of(acute_ones);
  for (LaneBits left = bits_of(which); left != 0; left &= left - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(left));
    const BlockPainter painter({images.line(0, lane), images.line(1, lane), images.line(2, lane)},
                               images.line(3, lane), primitives[lane], images.rectangle(lane));
    if ((acute >> lane & 1U) != 0) {
      painter.paint<true>(image);
    } else {
      painter.paint<false>(image);
    }
  }
}

/// Returns the triangles of `which` that cover at most 2 x 2 cells of hierarchical Z and are hidden
/// by it.
HWY_INLINE Mask hidden(const TriangleImages& images, Mask which, const TileImage& image) {
  const auto cell = [](Floats sample) {
    return hn::ShiftRight<3>(hn::ConvertTo(IntTag(), sample));
  };
  const auto of = hn::RebindMask(IntTag(), which);
  const Ints left = hn::IfThenElseZero(of, cell(images.left));
  const Ints right = hn::IfThenElseZero(of, cell(images.right));
  constexpr int kRow = std::countr_zero(static_cast<unsigned>(TileImage::kHzColumns));
  const Ints top = hn::IfThenElseZero(of, cell(images.top));
  const Ints bottom = hn::IfThenElseZero(of, cell(images.bottom));
  const Ints two = hn::Set(IntTag(), 2);
  const auto small =
      hn::And(of, hn::And(hn::Lt(hn::Sub(right, left), two), hn::Lt(hn::Sub(bottom, top), two)));
  const auto depth = [&](Ints column, Ints row) {
    return hn::GatherIndex(Tag(), image.farthest.data(), hn::Add(hn::ShiftLeft<kRow>(row), column));
  };
  const Floats farthest = hn::Min(hn::Min(depth(left, top), depth(right, top)),
                                  hn::Min(depth(left, bottom), depth(right, bottom)));
  return hn::And(hn::RebindMask(Tag(), small),
                 hn::Gt(farthest, hn::Mul(images.nearest, all(1.0F + 0x1p-18F))));
}

/// Draws triangles for which float is accurate enough, each by the method for its size.
HWY_INLINE void draw_triangles(const TriangleImages& images, const scenes::PrimitiveId* primitives,
                               TileImage& image) {
  const Mask small = hn::And(images.drawn, hn::Le(images.samples(), all(kMaxLaneSamples)));
  if (!hn::AllFalse(Tag(), small)) {
    Fragments fragments;
    collect_fragments(images, small, fragments);
    resolve_fragments(fragments, primitives, image);
  }
  Mask rest = hn::AndNot(small, images.drawn);
  if (hn::AllFalse(Tag(), rest)) return;
  rest = hn::AndNot(hidden(images, rest, image), rest);
  if (hn::AllFalse(Tag(), rest)) return;

  const StoredImages stored(images);
  const BlockBoxes boxes(images);
  const Mask few = hn::And(rest, hn::Le(boxes.count(), all(static_cast<float>(kMaxListedBlocks))));
  const Mask listed = hn::AndNot(images.acute, few);
  if (!hn::AllFalse(Tag(), listed)) {
    BlockList list;
    list_blocks(images, boxes, listed, list);
    paint_list(list, stored, primitives, image);
  }
  draw_large(stored, primitives, hn::AndNot(listed, rest), images.acute, image);
}

/// Draws a meshlet. Parts behind `farthest` (1/t) are not drawn, nor are the backs of the triangles
/// in `hidden`.
inline void draw_meshlet(const Meshlet& meshlet, std::uint32_t hidden, const TileRays& rays,
                         float farthest, TileImage& image) {
  ProjectedVertices projected;
  project_vertices(meshlet, rays.view, projected);
  if (hidden != 0 && projected.none_needs_double) {
    Survivors survivors;
    find_survivors(meshlet, HiddenBacks(meshlet, hidden, rays.view), projected, rays.view,
                   survivors);
    for (std::size_t first = 0; first < survivors.count; first += kLanes) {
      const TriangleImages images =
          project_triangles(survivors.from(first), projected, rays.view, farthest);
      draw_exactly(
          meshlet, [&](std::size_t lane) { return survivors.triangle(first + lane); },
          images.needs_exact, rays, image);
      draw_triangles(images, survivors.primitives.data() + first, image);
    }
    return;
  }
  for (std::size_t first = 0; first < meshlet.triangle_count; first += kLanes) {
    const TriangleImages images =
        project_triangles(TriangleCorners::from(meshlet, first), projected, rays.view, farthest);
    draw_exactly(
        meshlet, [&](std::size_t lane) { return first + lane; }, images.needs_exact, rays, image);
    draw_triangles(images, meshlet.primitives.data() + first, image);
  }
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

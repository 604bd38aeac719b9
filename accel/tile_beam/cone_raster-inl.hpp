// Draws cones into a tile: a box on the screen, then the equation for its samples.

#if defined(ACCEL_TILE_BEAM_CONE_RASTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_CONE_RASTER_INL
#undef ACCEL_TILE_BEAM_CONE_RASTER_INL
#else
#define ACCEL_TILE_BEAM_CONE_RASTER_INL
#endif

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "accel/core/intersect_cone.hpp"
#include "accel/tile_beam/box_probe-inl.hpp"
#include "accel/tile_beam/cone_equation.hpp"
#include "accel/tile_beam/ray_raster-inl.hpp"
#include "accel/tile_beam/row_ends-inl.hpp"
#include "accel/tile_beam/tile_hierarchy.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// The maximum distance of a point on the surface from the computed surface, in the equation's unit
/// of length: four roundings. A computed point is off by less than six, so hits are within the
/// differ's sixteen.
inline constexpr float kOnSurface = 0x1p-22F;
/// A height closer than this to that of a rim is doubtful.
inline constexpr float kAtRim = 0x1p-18F;

/// Cones whose boxes have at most this many samples are drawn faster ray by ray.
inline constexpr int kFewSamples = 2;

/// Returns a linear function at the first samples of a row, in the lanes of a register of a block.
HWY_INLINE Floats start_of_row(const TileLine& line, Floats j) {
  return hn::MulAdd(all(line.y), j, all(line.constant));
}

/// The properties of rays where they meet the infinite cone.
struct ConeRoot {
  Mask hit;       ///< the ray meets the frustum
  Mask doubtful;  ///< rounding decides whether it does
};

/// Directions in the axes of a `ConeEquation`.
struct ConeDirections {
  Floats beside;
  Floats across;
  Floats along;
};

/// Draws a cone into the tile's blocks.
template <bool kOutside>
class ConePainter {
 public:
  ConePainter(const ConeEquation& cone, bool inside_only, scenes::PrimitiveId primitive,
              float nearest)
      : cone_(cone), primitive_(primitive), nearest_(nearest), inside_only_(inside_only) {}

  /// Paints the samples of a box. `exact(column, row, samples)` receives, as bits, the samples of a
  /// block that depend on rounding.
  template <class Exact>
  HWY_INLINE void paint(const SampleRectangle& box, TileImage& image, Exact exact) const {
    const int first_column = box.left >> 2;
    const int last_column = box.right >> 2;
    const int first_row = box.top >> 2;
    const int last_row = box.bottom >> 2;
    if (!kOutside || (last_column - first_column + 1) * (last_row - first_row + 1) <= kFewBlocks) {
      for (int row = first_row; row <= last_row; ++row) {
        paint_row(row, first_column, last_column, image, exact);
      }
      return;
    }
    std::array<TileLine, 2> sides = cone_.sides;
    for (TileLine& side : sides) side.constant += cone_.least_side;
    const RowEnds ends(sides, first_column, last_column);
    for (int row = first_row; row <= last_row; ++row) {
      paint_row(row, ends.first(row), ends.last(row), image, exact);
    }
  }

 private:
  static constexpr int kFewBlocks = 8;  ///< with fewer, finding row ends costs more than it saves

  template <class Exact>
  HWY_INLINE void paint_row(int row, int first_column, int last_column, TileImage& image,
                            Exact exact) const {
    for (std::size_t first = 0; first < TileImage::kBlockSamples; first += kLanes) {
      const Floats j = hn::Add(block_y(first), all(static_cast<float>(4 * row)));
      const Floats side0 = start_of_row(cone_.sides[0], j);
      const Floats side1 = start_of_row(cone_.sides[1], j);
      const Floats half_linear = start_of_row(cone_.half_linear, j);
      const Floats beside = start_of_row(cone_.beside, j);
      const Floats across = start_of_row(cone_.across, j);
      const Floats along = start_of_row(cone_.along, j);
      Floats i = hn::Add(block_x(first), all(static_cast<float>(4 * first_column)));
      std::size_t at = TileImage::block(first_column, row) + first;
      for (int column = first_column; column <= last_column;
           ++column, i = hn::Add(i, all(4.0F)), at += TileImage::kBlockSamples) {
        const Floats a_side = hn::MulAdd(all(cone_.sides[0].x), i, side0);
        const Floats b_side = hn::MulAdd(all(cone_.sides[1].x), i, side1);
        Mask met = hn::Le(load(&image.inverse_t[at]), all(nearest_));
        Mask doubtful = mask_of(0);
        Floats square;
        if constexpr (kOutside) {
          const Floats inner = hn::Min(a_side, b_side);
          met = hn::And(met, hn::Ge(inner, all(-cone_.least_side)));
          doubtful = hn::Le(inner, all(cone_.least_side));
          square = hn::Max(hn::Mul(a_side, b_side), hn::Zero(Tag()));
        } else {
          square = hn::MulAdd(a_side, a_side, hn::Mul(b_side, b_side));
        }
        if (hn::AllFalse(Tag(), met)) continue;
        const Floats b = hn::MulAdd(all(cone_.half_linear.x), i, half_linear);
        ConeDirections d;
        d.beside = hn::MulAdd(all(cone_.beside.x), i, beside);
        d.across = hn::MulAdd(all(cone_.across.x), i, across);
        d.along = hn::MulAdd(all(cone_.along.x), i, along);
        const LaneBits left = paint_block(d, b, square, met, doubtful, at, image);
        if (left != 0) exact(column, row, left << first);
      }
    }
  }

  /// Returns the samples of a register that depend on rounding; they are not painted.
  HWY_INLINE LaneBits paint_block(const ConeDirections& d, Floats b, Floats square, Mask met,
                                  Mask doubtful, std::size_t at, TileImage& image) const {
    const Floats across_squared = hn::Mul(d.across, d.across);
    const Floats radius = hn::Mul(all(cone_.sine), d.along);
    const auto classify = [&](Floats w) { return met_at(w, d, across_squared, radius); };
    // The roots q / c and a / q, without cancellation: with b < 0 the ray enters at the first.
    const Floats q = hn::Neg(hn::Add(b, hn::CopySign(hn::Sqrt(square), b)));
    const Mask approaches = hn::Lt(b, hn::Zero(Tag()));
    const Mask enters = hn::Eq(all(inside_only_ ? 1.0F : 0.0F), hn::Zero(Tag()));
    Floats w = hn::Mul(q, all(cone_.inverse_constant));
    const ConeRoot first = classify(w);
    Mask hit = hn::And(first.hit, hn::Or(hn::Not(approaches), enters));
    doubtful = hn::Or(hn::Or(doubtful, first.doubtful), hn::Le(hn::Abs(q), all(cone_.least_root)));
    // The ray meets the cone at both roots only if it approaches, and then the first is nearer.
    const Mask decided = hn::Or(doubtful, hit);
    if (!hn::AllFalse(Tag(), hn::AndNot(decided, met))) {
      const Floats a =
          hn::NegMulAdd(radius, radius, hn::MulAdd(d.beside, d.beside, across_squared));
      const Floats other = hn::Div(a, q);
      const ConeRoot second = classify(other);
      const Mask hit_there = hn::AndNot(decided, hn::And(second.hit, hn::Or(approaches, enters)));
      doubtful = hn::Or(doubtful, hn::AndNot(decided, second.doubtful));
      w = hn::IfThenElse(hit_there, other, w);
      hit = hn::Or(hit, hit_there);
    }
    keep_nearer(image, at, hn::Mul(w, all(cone_.per_length)),
                hn::And(met, hn::AndNot(doubtful, hit)), primitive_);
    return bits_of(hn::And(met, doubtful));
  }

  /// Returns whether the root w is a point of the frustum. Comparing the computed point with the
  /// surface detects the rare inaccurate root.
  HWY_INLINE ConeRoot met_at(Floats w, const ConeDirections& d, Floats across_squared,
                             Floats along_radius) const {
    const Floats beside = hn::MulAdd(all(cone_.eye_beside), w, d.beside);
    const Floats radius = hn::MulAdd(all(cone_.eye_radius), w, along_radius);
    const Floats height = hn::MulAdd(all(cone_.eye_height), w, d.along);
    // The difference of the squares is the distance from the surface times twice the radius.
    const Floats off =
        hn::Abs(hn::NegMulAdd(radius, radius, hn::MulAdd(beside, beside, across_squared)));
    const Mask on = hn::Le(off, hn::Mul(hn::Mul(all(2.0F * kOnSurface), w), hn::Abs(radius)));
    const Floats beyond = hn::NegMulAdd(all(cone_.half_length), w, hn::Abs(height));
    const Floats rim = hn::Mul(all(kAtRim), w);
    // All of the cone has w >= 1, and no root is so inaccurate that its w would be below 1/2.
    const Mask seen = hn::Ge(w, all(0.5F));
    const Mask inside = hn::And(on, hn::Le(beyond, hn::Neg(rim)));
    const Mask outside = hn::And(on, hn::Ge(beyond, rim));
    return {hn::And(seen, inside), hn::AndNot(hn::Or(inside, outside), seen)};
  }

  const ConeEquation& cone_;
  scenes::PrimitiveId primitive_;
  float nearest_;
  bool inside_only_;
};

/// Draws the cones of a block, the nearest first. Parts behind `farthest` (1/t) are not drawn.
/// Returns how many samples needed the canonical test because they depended on rounding.
inline std::uint64_t draw_cones(const ConeBlock& block, const scenes::Scene& scene,
                                const TileRays& rays, const BoxProbe& probe, float farthest,
                                TileImage& image) {
  std::uint64_t doubtful = 0;
  BoxProbe::Met met;
  probe.probe(block.boxes, block.count, farthest, met);
  for (LaneBits left = met.lanes; left != 0;) {
    const std::size_t lane = largest_of(met.nearest, left);
    left &= ~(LaneBits{1} << lane);
    const float nearest = met.nearest[lane];
    const SampleRectangle box = met.where(lane);
    if (hides(image, box, nearest)) continue;
    const scenes::PrimitiveId primitive = block.primitives[lane];
    const scenes::Cone& cone = scene.cones[scene.primitives[primitive].index];
    const auto intersect = [&](const CanonicalRay& ray) { return intersect_cone(ray, cone); };
    std::optional<ConeEquation> equation;
    if (box.count() > kFewSamples) equation = cone_equation(cone, rays.raster, rays.view);
    if (!equation) {
      draw_by_rays(rays, box, nearest, primitive, image, intersect);
    } else {
      const auto exact = [&](int column, int row, LaneBits samples) {
        doubtful += static_cast<std::uint64_t>(std::popcount(samples));
        for (; samples != 0; samples &= samples - 1) {
          const int sample = std::countr_zero(samples);
          draw_by_ray(rays, 4 * column + (sample & 3), 4 * row + (sample >> 2), nearest, primitive,
                      image, intersect);
        }
      };
      if (equation->outside) {
        ConePainter<true>(*equation, cone.inside_only, primitive, nearest).paint(box, image, exact);
      } else {
        ConePainter<false>(*equation, cone.inside_only, primitive, nearest)
            .paint(box, image, exact);
      }
    }
    mark_stale(image, box);
  }
  return doubtful;
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

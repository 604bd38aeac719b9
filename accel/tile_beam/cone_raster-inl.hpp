// Drawing cones into a tile: a box on the screen, then the equation for its samples.

#if defined(ACCEL_TILE_BEAM_CONE_RASTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_CONE_RASTER_INL
#undef ACCEL_TILE_BEAM_CONE_RASTER_INL
#else
#define ACCEL_TILE_BEAM_CONE_RASTER_INL
#endif

#include <bit>
#include <optional>

#include "accel/core/intersect_cone.hpp"
#include "accel/tile_beam/box_probe-inl.hpp"
#include "accel/tile_beam/cone_equation.hpp"
#include "accel/tile_beam/ray_raster-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// How far a point may be from the surface to be on it, in the equation's unit of lengths: four
/// roundings. What is computed of a point errs by less than six, so that hits lie within the
/// differ's sixteen.
inline constexpr float kOnSurface = 0x1p-22F;
/// A height is doubtful nearer than this to that of a rim.
inline constexpr float kAtRim = 0x1p-18F;

/// Boxes of no more samples than this take less time ray by ray.
inline constexpr int kFewSamples = 2;

/// A function on the screen at the samples of one row, for each register of a block.
HWY_INLINE Floats start_of_row(const ScreenLinear& function, Floats j) {
  return hn::MulAdd(all(function.down), j, all(function.first));
}
HWY_INLINE Floats at_column(const ScreenLinear& function, Floats row_start, Floats i) {
  return hn::MulAdd(all(function.right), i, row_start);
}

/// What is known of rays where they meet the infinite cone.
struct ConeRoot {
  Mask hit;       ///< the frustum is met
  Mask doubtful;  ///< rounding decides whether it is
};

/// Directions in the axes of a `ConeEquation`.
struct ConeDirections {
  Floats beside;
  Floats across_squared;
  Floats along;
  Floats radius;  ///< sine x along
};

/// Is the root w a point of the frustum? The point is computed and compared with the surface: an
/// inaccurate root, which is rare, is found to be beside it.
HWY_INLINE ConeRoot classify(const ConeEquation& cone, const ConeDirections& d, Floats w) {
  const Floats beside = hn::MulAdd(all(cone.eye_beside), w, d.beside);
  const Floats radius = hn::MulAdd(all(cone.eye_radius), w, d.radius);
  const Floats height = hn::MulAdd(all(cone.eye_height), w, d.along);
  // The difference of the squares is the distance from the surface times twice the radius.
  const Floats off =
      hn::Abs(hn::NegMulAdd(radius, radius, hn::MulAdd(beside, beside, d.across_squared)));
  const Mask on = hn::Le(off, hn::Mul(hn::Mul(all(2.0F * kOnSurface), w), hn::Abs(radius)));
  const Floats beyond = hn::NegMulAdd(all(cone.half_length), w, hn::Abs(height));
  const Floats rim = hn::Mul(all(kAtRim), w);
  // All of the cone has w >= 1, and no root is so inaccurate that its w would come out below 1/2.
  const Mask seen = hn::Ge(w, all(0.5F));
  const Mask inside = hn::And(on, hn::Le(beyond, hn::Neg(rim)));
  const Mask outside = hn::And(on, hn::Ge(beyond, rim));
  return {hn::And(seen, inside), hn::AndNot(hn::Or(inside, outside), seen)};
}

/// Draws one cone into the blocks of a box. `exact(column, row, samples)` decides the samples of a
/// block whose bits are set by the canonical test.
template <bool kOutside, class Exact>
HWY_INLINE void draw_cone(const ConeEquation& cone, bool inside_only, scenes::PrimitiveId primitive,
                          const SampleRectangle& box, float nearest, TileImage& image,
                          Exact exact) {
  const Floats none = hn::Zero(Tag());
  const Mask enters = hn::Eq(all(inside_only ? 1.0F : 0.0F), none);  // and not only leaves
  for (int row = box.top >> 2; row <= box.bottom >> 2; ++row) {
    for (std::size_t first = 0; first < TileImage::kBlockSamples; first += kLanes) {
      const Floats j = hn::Add(block_y(first), all(static_cast<float>(4 * row)));
      const Floats first_side = start_of_row(cone.first_side, j);
      const Floats second_side = start_of_row(cone.second_side, j);
      for (int column = box.left >> 2; column <= box.right >> 2; ++column) {
        const Floats i = hn::Add(block_x(first), all(static_cast<float>(4 * column)));
        const Floats side = at_column(cone.first_side, first_side, i);
        const Floats other = at_column(cone.second_side, second_side, i);
        const Floats square =
            kOutside ? hn::Mul(side, other) : hn::MulAdd(side, side, hn::Mul(other, other));
        const Mask touched = hn::Le(hn::Min(hn::Abs(side), hn::Abs(other)), all(cone.least_side));
        const std::size_t at = TileImage::block(column, row) + first;
        const Mask met = hn::And(hn::Or(hn::Ge(square, none), touched),
                                 hn::Le(load(&image.inverse_t[at]), all(nearest)));
        if (hn::AllFalse(Tag(), met)) continue;

        const Floats root = hn::Sqrt(hn::Max(square, none));
        const Floats b = at_column(cone.half_linear, start_of_row(cone.half_linear, j), i);
        const Mask enters_first = hn::Lt(b, none);
        const Floats q = hn::Neg(hn::Add(b, hn::CopySign(root, b)));
        ConeDirections d;
        d.beside = at_column(cone.beside, start_of_row(cone.beside, j), i);
        const Floats across = at_column(cone.across, start_of_row(cone.across, j), i);
        d.across_squared = hn::Mul(across, across);
        d.along = at_column(cone.along, start_of_row(cone.along, j), i);
        d.radius = hn::Mul(all(cone.sine), d.along);

        // The two roots, c w = q and a = w q, of which one is where the ray enters.
        const Floats w1 = hn::Mul(q, all(cone.inverse_constant));
        const ConeRoot one = classify(cone, d, w1);
        const Mask hit1 = hn::And(one.hit, hn::Or(hn::Not(enters_first), enters));
        Mask doubtful =
            hn::Or(hn::Or(touched, one.doubtful), hn::Le(hn::Abs(q), all(cone.least_root)));
        Mask hit = hit1;
        Floats w = w1;
        if (!hn::AllTrue(Tag(),
                         hn::Or(hn::Not(met), hn::Or(doubtful, hn::And(hit1, enters_first))))) {
          const Floats a =
              hn::NegMulAdd(d.radius, d.radius, hn::MulAdd(d.beside, d.beside, d.across_squared));
          const Floats w2 = hn::Div(a, q);
          const ConeRoot two = classify(cone, d, w2);
          const Mask hit2 = hn::And(two.hit, hn::Or(enters_first, enters));
          const Mask decided = hn::And(hit1, enters_first);
          doubtful = hn::Or(doubtful, hn::AndNot(decided, two.doubtful));
          w = hn::IfThenElse(hn::And(hit2, hn::Or(hn::Not(hit1), hn::Gt(w2, w1))), w2, w1);
          hit = hn::Or(hit1, hit2);
        }
        keep_nearer(image, at, hn::Mul(w, all(cone.per_length)),
                    hn::And(met, hn::AndNot(doubtful, hit)), primitive);
        const LaneBits left = bits_of(hn::And(met, doubtful));
        if (left != 0) exact(column, row, left << first);
      }
    }
  }
}

/// Draws the cones of a block, the nearest first. What lies behind `farthest` (1/t) is not drawn.
inline void draw_cones(const ConeBlock& block, const scenes::Scene& scene, const TileRays& rays,
                       const BoxProbe& probe, float farthest, TileImage& image) {
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
        for (; samples != 0; samples &= samples - 1) {
          const int sample = std::countr_zero(samples);
          draw_by_ray(rays, 4 * column + (sample & 3), 4 * row + (sample >> 2), nearest, primitive,
                      image, intersect);
        }
      };
      if (equation->outside) {
        draw_cone<true>(*equation, cone.inside_only, primitive, box, nearest, image, exact);
      } else {
        draw_cone<false>(*equation, cone.inside_only, primitive, box, nearest, image, exact);
      }
    }
    mark_stale(image, box);
  }
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

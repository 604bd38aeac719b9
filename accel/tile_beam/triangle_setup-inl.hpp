// The images of triangles, one per lane.

#if defined(ACCEL_TILE_BEAM_TRIANGLE_SETUP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_TRIANGLE_SETUP_INL
#undef ACCEL_TILE_BEAM_TRIANGLE_SETUP_INL
#else
#define ACCEL_TILE_BEAM_TRIANGLE_SETUP_INL
#endif

#include "accel/tile_beam/lanes-inl.hpp"
#include "accel/tile_beam/tile_hierarchy.hpp"
#include "accel/tile_beam/tile_view.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// A meshlet's vertices on the screen.
struct ProjectedVertices {
  alignas(64) std::array<float, Meshlet::kMaxVertices> x;
  alignas(64) std::array<float, Meshlet::kMaxVertices> y;
  /// 1 / depth; -1 for vertices whose triangles need double: behind the eye or far outside the
  /// tile.
  alignas(64) std::array<float, Meshlet::kMaxVertices> inverse_t;
  bool none_needs_double;  ///< no vertex has -1
};

HWY_INLINE void project_vertices(const Meshlet& meshlet, const TileView& view,
                                 ProjectedVertices& projected) {
  const Points eye = all_of(view.eye);
  const Points to_x = all_of(view.x);
  const Points to_y = all_of(view.y);
  const Points to_depth = all_of(view.depth);
  const Floats guard = all(view.guard);
  projected.none_needs_double = true;
  for (std::size_t i = 0; i < meshlet.vertex_count; i += kLanes) {
    const Points p{hn::Sub(load(&meshlet.vertices[0][i]), eye.x),
                   hn::Sub(load(&meshlet.vertices[1][i]), eye.y),
                   hn::Sub(load(&meshlet.vertices[2][i]), eye.z)};
    const Floats depth = dot(to_depth, p);
    const Floats inverse_t = hn::Div(all(1.0F), depth);
    const Floats x = hn::Mul(dot(to_x, p), inverse_t);
    const Floats y = hn::Mul(dot(to_y, p), inverse_t);
    const Mask in_guard_band = hn::And(hn::Gt(depth, all(view.slack_depth)),
                                       hn::Le(hn::Max(hn::Abs(x), hn::Abs(y)), guard));
    store(x, &projected.x[i]);
    store(y, &projected.y[i]);
    store(hn::IfThenElse(in_guard_band, inverse_t, all(-1.0F)), &projected.inverse_t[i]);
    const Mask beyond_last = hn::Not(hn::FirstN(Tag(), meshlet.vertex_count - i));
    projected.none_needs_double &= hn::AllTrue(Tag(), hn::Or(in_guard_band, beyond_last));
  }
}

/// The linear functions x * i + y * j + constant of a sample (i, j), one per lane.
struct Lines {
  Floats x;
  Floats y;
  Floats constant;

  HWY_INLINE Floats at(Floats i, Floats j) const {
    return hn::MulAdd(x, i, hn::MulAdd(y, j, constant));
  }
};

/// The images of some triangles.
struct TriangleImages {
  Lines edge0;  ///< inside if none is negative
  Lines edge1;
  Lines edge2;
  Lines plane;     ///< 1/t
  Floats nearest;  ///< the largest 1/t of the corners
  Floats left;     ///< the samples that may be inside
  Floats right;
  Floats top;
  Floats bottom;
  Mask drawn;        ///< may hit samples, and float is accurate enough
  Mask acute;        ///< has a corner so acute that rounding may draw it far beyond its box
  Mask needs_exact;  ///< may hit samples, but float is too coarse: see exact_triangle.hpp

  /// Returns the number of samples in the triangles' boxes.
  HWY_INLINE Floats samples() const {
    const Floats one = all(1.0F);
    return hn::Mul(hn::Add(hn::Sub(right, left), one), hn::Add(hn::Sub(bottom, top), one));
  }
};

/// The ratio of a triangle's area to the square of its longer side below which corners count as
/// acute.
inline constexpr float kAcute = 0x1p-5F;

/// Returns the edge from (x0, y0) to (x1, y1). Its constant is computed at the midpoint, so that
/// the reversed edge has exactly the negated value at every sample and two triangles that share it
/// leave no gap (this requires -ffp-contract=off).
HWY_INLINE Lines edge_between(Floats x0, Floats y0, Floats x1, Floats y1, Floats sign) {
  const Floats a = hn::Sub(y0, y1);
  const Floats b = hn::Sub(x1, x0);
  const Floats twice = hn::Add(hn::Mul(a, hn::Add(x0, x1)), hn::Mul(b, hn::Add(y0, y1)));
  return {hn::Mul(a, sign), hn::Mul(b, sign), hn::Mul(twice, hn::Mul(all(-0.5F), sign))};
}

/// Triangles of a meshlet, one for each lane: the numbers of their corners.
struct TriangleCorners {
  Ints corner0;
  Ints corner1;
  Ints corner2;
  Mask present;

  /// Returns the triangles from `first` on.
  static HWY_INLINE TriangleCorners from(const Meshlet& meshlet, std::size_t first) {
    const hn::Rebind<std::uint8_t, Tag> bytes;
    const auto corner = [&](std::size_t which) {
      return hn::PromoteTo(IntTag(), hn::LoadU(bytes, meshlet.corners[which].data() + first));
    };
    return {corner(0), corner(1), corner(2), hn::FirstN(Tag(), meshlet.triangle_count - first)};
  }
};

/// The triangles whose backs are invisible: one mask for those that show their back if their area
/// on the screen is positive, and one for those that show it if the area is negative.
struct HiddenBacks {
  std::uint32_t positive;
  std::uint32_t negative;

  HWY_INLINE HiddenBacks(const Meshlet& meshlet, std::uint32_t hidden, const TileView& view)
      : positive(hidden & (view.mirrored ? meshlet.clockwise : ~meshlet.clockwise)),
        negative(hidden & ~positive) {}
};

/// The triangles of a meshlet that remain after culling.
struct Survivors {
  static constexpr std::size_t kRoom = Meshlet::kMaxTriangles + 16;  // for a register at the end

  /// The indices of the corners in the three lower bytes and that of the triangle in the highest.
  alignas(64) std::array<std::int32_t, kRoom> corners;
  alignas(64) std::array<scenes::PrimitiveId, kRoom> primitives;
  std::size_t count = 0;

  HWY_INLINE TriangleCorners from(std::size_t first) const {
    const Ints packed = hn::Load(IntTag(), corners.data() + first);
    // Lanes without a triangle are not initialized, but must not index beyond a Table32 either.
    const Ints last = hn::Set(IntTag(), Meshlet::kMaxVertices - 1);
    return {hn::And(packed, last), hn::And(hn::ShiftRight<8>(packed), last),
            hn::And(hn::ShiftRight<16>(packed), last), hn::FirstN(Tag(), count - first)};
  }
  std::size_t triangle(std::size_t number) const {
    return static_cast<std::uint32_t>(corners[number]) >> 24U;
  }
};

/// Finds the triangles that show no hidden back and whose box contains a sample. No vertex may need
/// double. A triangle counts as showing its back only if its area proves it despite the rounding of
/// its corners, up to `box_slack` each.
HWY_INLINE void find_survivors(const Meshlet& meshlet, const HiddenBacks& backs,
                               const ProjectedVertices& projected, const TileView& view,
                               Survivors& survivors) {
  const Table32 xs(projected.x.data());
  const Table32 ys(projected.y.data());
  const Floats slack = all(view.box_slack);
  const Floats none = hn::Zero(Tag());
  for (std::size_t first = 0; first < meshlet.triangle_count; first += kLanes) {
    const TriangleCorners corners = TriangleCorners::from(meshlet, first);
    const Floats x0 = xs.at(corners.corner0), x1 = xs.at(corners.corner1),
                 x2 = xs.at(corners.corner2);
    const Floats y0 = ys.at(corners.corner0), y1 = ys.at(corners.corner1),
                 y2 = ys.at(corners.corner2);
    const Floats x_low = hn::Min(x0, hn::Min(x1, x2));
    const Floats x_high = hn::Max(x0, hn::Max(x1, x2));
    const Floats y_low = hn::Min(y0, hn::Min(y1, y2));
    const Floats y_high = hn::Max(y0, hn::Max(y1, y2));
    const Floats left = hn::Ceil(hn::Max(hn::Sub(x_low, slack), none));
    const Floats top = hn::Ceil(hn::Max(hn::Sub(y_low, slack), none));
    const Floats right = hn::Min(hn::Add(x_high, slack), all(static_cast<float>(view.width - 1)));
    const Floats bottom = hn::Min(hn::Add(y_high, slack), all(static_cast<float>(view.height - 1)));
    const Mask holds_sample = hn::And(hn::Le(left, right), hn::Le(top, bottom));

    const Floats dx1 = hn::Sub(x1, x0), dx2 = hn::Sub(x2, x0);
    const Floats dy1 = hn::Sub(y1, y0), dy2 = hn::Sub(y2, y0);
    const Floats area = hn::MulSub(dx1, dy2, hn::Mul(dx2, dy1));
    const Floats side = hn::Max(hn::Sub(x_high, x_low), hn::Sub(y_high, y_low));
    const Floats doubtful = hn::MulAdd(hn::Mul(side, side), hn::Mul(side, all(view.sliver)),
                                       hn::Mul(side, all(8.0F * view.box_slack)));
    const Mask back =
        hn::Or(hn::And(mask_of(backs.positive >> first), hn::Gt(area, doubtful)),
               hn::And(mask_of(backs.negative >> first), hn::Lt(area, hn::Neg(doubtful))));
    const Mask left_over = hn::AndNot(back, hn::And(corners.present, holds_sample));
    const Ints number = hn::Iota(IntTag(), static_cast<int>(first));
    const Ints packed =
        hn::Or(hn::Or(corners.corner0, hn::ShiftLeft<8>(corners.corner1)),
               hn::Or(hn::ShiftLeft<16>(corners.corner2), hn::ShiftLeft<24>(number)));
    compress_store(IntTag(), packed, hn::RebindMask(IntTag(), left_over),
                   survivors.corners.data() + survivors.count);
    const hn::RebindToUnsigned<Tag> ids;
    survivors.count += compress_store(ids, hn::LoadU(ids, meshlet.primitives.data() + first),
                                      hn::RebindMask(ids, left_over),
                                      survivors.primitives.data() + survivors.count);
  }
}

/// Projects triangles. Those that contain no sample or are entirely behind `farthest` (1/t) are in
/// neither mask.
HWY_INLINE TriangleImages project_triangles(const TriangleCorners& corners,
                                            const ProjectedVertices& projected,
                                            const TileView& view, float farthest) {
  const Table32 xs(projected.x.data());
  const Table32 ys(projected.y.data());
  const Table32 inverse_ts(projected.inverse_t.data());
  const Floats x0 = xs.at(corners.corner0), x1 = xs.at(corners.corner1),
               x2 = xs.at(corners.corner2);
  const Floats y0 = ys.at(corners.corner0), y1 = ys.at(corners.corner1),
               y2 = ys.at(corners.corner2);
  const Floats z0 = inverse_ts.at(corners.corner0), z1 = inverse_ts.at(corners.corner1),
               z2 = inverse_ts.at(corners.corner2);
  const Mask present = corners.present;

  TriangleImages images;
  const Floats x_low = hn::Min(x0, hn::Min(x1, x2));
  const Floats x_high = hn::Max(x0, hn::Max(x1, x2));
  const Floats y_low = hn::Min(y0, hn::Min(y1, y2));
  const Floats y_high = hn::Max(y0, hn::Max(y1, y2));
  const Floats slack = all(view.box_slack);
  const Floats none = hn::Zero(Tag());
  images.left = hn::Ceil(hn::Max(hn::Sub(x_low, slack), none));
  images.top = hn::Ceil(hn::Max(hn::Sub(y_low, slack), none));
  images.right =
      hn::Floor(hn::Min(hn::Add(x_high, slack), all(static_cast<float>(view.width - 1))));
  images.bottom =
      hn::Floor(hn::Min(hn::Add(y_high, slack), all(static_cast<float>(view.height - 1))));
  images.nearest = hn::Max(z0, hn::Max(z1, z2));

  const Mask in_guard_band = hn::Gt(hn::Min(z0, hn::Min(z1, z2)), none);
  const Mask in_tile =
      hn::And(hn::And(hn::Le(images.left, images.right), hn::Le(images.top, images.bottom)),
              hn::Ge(hn::Mul(images.nearest, all(1.0F + 0x1p-20F)), all(farthest)));
  const Mask candidates = hn::And(present, hn::And(in_guard_band, in_tile));

  const Floats dx1 = hn::Sub(x1, x0), dx2 = hn::Sub(x2, x0);
  const Floats dy1 = hn::Sub(y1, y0), dy2 = hn::Sub(y2, y0);
  const Floats dz1 = hn::Sub(z1, z0), dz2 = hn::Sub(z2, z0);
  const Floats area = hn::MulSub(dx1, dy2, hn::Mul(dx2, dy1));
  const Floats side = hn::Max(hn::Sub(x_high, x_low), hn::Sub(y_high, y_low));
  images.acute = hn::Le(hn::Abs(area), hn::Mul(hn::Mul(side, side), all(kAcute)));
  const Floats too_thin = hn::Mul(hn::Mul(side, side), hn::Mul(side, all(view.sliver)));
  const Mask thin = hn::Le(hn::Abs(area), too_thin);
  images.drawn = hn::AndNot(thin, candidates);
  images.needs_exact = hn::Or(hn::And(candidates, thin), hn::AndNot(in_guard_band, present));

  const Floats sign = hn::CopySign(all(1.0F), area);
  images.edge0 = edge_between(x0, y0, x1, y1, sign);
  images.edge1 = edge_between(x1, y1, x2, y2, sign);
  images.edge2 = edge_between(x2, y2, x0, y0, sign);
  const Floats per_area = hn::Div(all(1.0F), area);
  images.plane.x = hn::Mul(per_area, hn::MulSub(dz1, dy2, hn::Mul(dz2, dy1)));
  images.plane.y = hn::Mul(per_area, hn::MulSub(dx1, dz2, hn::Mul(dx2, dz1)));
  images.plane.constant = hn::NegMulAdd(images.plane.x, x0, hn::NegMulAdd(images.plane.y, y0, z0));
  return images;
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

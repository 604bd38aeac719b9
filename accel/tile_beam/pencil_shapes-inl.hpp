// The contents of a leaf as seen from a pencil's apex: bounds, and data for the tests of rays.

#if defined(ACCEL_TILE_BEAM_PENCIL_SHAPES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_PENCIL_SHAPES_INL
#undef ACCEL_TILE_BEAM_PENCIL_SHAPES_INL
#else
#define ACCEL_TILE_BEAM_PENCIL_SHAPES_INL
#endif

#include <bit>

#include "accel/tile_beam/exact_triangle.hpp"
#include "accel/tile_beam/pencil_points-inl.hpp"
#include "accel/tile_beam/sphere_raster-inl.hpp"
#include "accel/tile_beam/tile_hierarchy.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// The viewpoint of a side of the cube.
struct ApexView {
  glm::vec3 apex;
  CubeSide side;
  float scene_size;  ///< the largest |coordinate|
  /// Shapes closer to the apex are left to the canonical test, because some ray ends before them;
  /// all rays of a bundle may hit them.
  float end;
  float radius;  ///< of the ball around the apex (HullPolicy); otherwise 0, as is `spread`
  float spread;
  bool ends_at_apex;  ///< for a bundle: no ray ends before a shape

  /// Returns world coordinates in the order of the side's axes.
  HWY_INLINE Points turned(Floats x, Floats y, Floats z) const {
    const Points world{x, y, z};
    return {coordinate(world, side.x_axis()), coordinate(world, side.y_axis()),
            hn::Mul(coordinate(world, side.z_axis()), all(side.sign()))};
  }
  /// Returns the coordinates of turned points relative to the apex, along the side's axes.
  HWY_INLINE Points from_apex(const Points& at) const {
    const auto component = [&](std::size_t axis) { return apex[static_cast<int>(axis)]; };
    return {hn::Sub(at.x, all(component(side.x_axis()))),
            hn::Sub(at.y, all(component(side.y_axis()))),
            hn::Sub(at.z, all(component(side.z_axis()) * side.sign()))};
  }
};

/// Bounds on the side, and of w.
struct SeenBounds {
  Floats low_u, high_u, low_v, high_v, low_w, high_w;
};

/// Widens a bundle's bounds on the side.
template <class Policy>
HWY_INLINE SeenBounds widened(const SeenBounds& bounds, Floats more) {
  if constexpr (!Policy::kHull) return bounds;
  return {hn::Sub(bounds.low_u, more),
          hn::Add(bounds.high_u, more),
          hn::Sub(bounds.low_v, more),
          hn::Add(bounds.high_v, more),
          bounds.low_w,
          bounds.high_w};
}

/// The largest w, for parts at or beside the apex.
inline constexpr float kAtApex = 1e30F;

/// Returns the bounds, without limits in lanes that are not `bounded`.
HWY_INLINE SeenBounds anywhere_unless(Mask bounded, const SeenBounds& bounds) {
  const auto low = [&](Floats value) { return hn::IfThenElse(bounded, value, all(-kAtApex)); };
  const auto high = [&](Floats value) { return hn::IfThenElse(bounded, value, all(kAtApex)); };
  return {low(bounds.low_u),   high(bounds.high_u), low(bounds.low_v),
          high(bounds.high_v), low(bounds.low_w),   high(bounds.high_w)};
}

/// Returns the bounds of boxes, which are exact, because boxes and sides have the same axes. Lanes
/// of boxes behind the apex are not set in `seen`.
template <class Policy>
HWY_INLINE SeenBounds bounds_of(const TileBoxes& boxes, std::size_t lane, const ApexView& view,
                                Mask& seen) {
  const auto plane = [&](std::size_t row, std::size_t axis) {
    return hn::Sub(load(&boxes.planes[row + axis][lane]), all(view.apex[static_cast<int>(axis)]));
  };
  const std::size_t x = view.side.x_axis();
  const std::size_t y = view.side.y_axis();
  const std::size_t z = view.side.z_axis();
  const bool positive = view.side.sign() > 0.0F;
  const Floats near_z = positive ? plane(0, z) : hn::Neg(plane(3, z));
  const Floats far_z = positive ? plane(3, z) : hn::Neg(plane(0, z));
  const Floats high_w =
      hn::IfThenElse(hn::Gt(near_z, all(1.0F / kAtApex)), hn::Div(all(1.0F), near_z), all(kAtApex));
  const Floats low_w = hn::Div(all(1.0F), far_z);
  seen = hn::Gt(far_z, hn::Zero(Tag()));
  const auto low = [&](Floats end) { return hn::Min(hn::Mul(end, high_w), hn::Mul(end, low_w)); };
  const auto high = [&](Floats end) { return hn::Max(hn::Mul(end, high_w), hn::Mul(end, low_w)); };
  const SeenBounds bounds{
      low(plane(0, x)), high(plane(3, x)), low(plane(0, y)), high(plane(3, y)), low_w, high_w};
  if constexpr (!Policy::kHull) return bounds;
  seen = hn::Gt(far_z, all(-1.001F * view.radius));
  return anywhere_unless(hn::Gt(near_z, all(view.end)), bounds);
}

/// The errors allowed for a ray's origin in float, in units of 2^-24 (see TriangleShapes): of its
/// place; of its distance from the line through the apex, to be multiplied by the scene's size and
/// w; and of its depth.
template <class Policy>
inline constexpr float kSlackOfPlaces = Policy::kClosest ? 36.0F : 8.0F;
template <class Policy>
inline constexpr float kSlackOfOrigins = Policy::kClosest ? 16.0F : 0.0F;
template <class Policy>
inline constexpr float kSlackOfDepths = Policy::kClosest ? 48.0F : 16.0F;

/// Up to 32 shapes of a leaf; each row holds one number of every shape.
struct SeenShapes {
  enum Row : std::size_t {
    kLowU,
    kHighU,
    kLowV,
    kHighV,
    kLowW,
    kHighW,
    /// Triangles: three edges a u + b v + c, nonnegative inside; the plane (x, y, z) and its
    /// distance, so that the triangle's w is (x u + y v + z) / distance; the magnitudes of a, b, x
    /// and y. In any-hit queries, the plane and the distance are moved toward the rays by the
    /// slack.
    kEdge0,
    kPlane = kEdge0 + 9,
    kDistance = kPlane + 3,
    kMagnitudes,
    /// Triangles: the error bound of plane - distance w, slack + slack per w * w; twice as much if
    /// the plane was moved by it.
    kSlack = kMagnitudes + 8,
    kSlackPerW,
    /// Triangles: the value of an edge below which a hit is uncertain.
    kEdgeMargin,
    kRows,
    /// Spheres: center and radius in the coordinates of the side.
    kCenter = kEdge0,
    kRadius = kCenter + 3
  };
  static constexpr std::size_t kMax = 32;

  alignas(64) std::array<std::array<float, kMax>, kRows> rows;
  LaneBits present;  ///< shapes that may be visible at all
  LaneBits exact;    ///< triangles that use `exact_triangle`'s tests
  LaneBits by_rays;  ///< decided by the canonical test, ray by ray
  LaneBits around;   ///< spheres that contain the apex
  std::array<ExactApexTriangle, kMax> exact_triangle;

  HWY_INLINE Floats at(std::size_t row, std::size_t lane) const { return load(&rows[row][lane]); }
  HWY_INLINE void set(std::size_t row, std::size_t lane, Floats values) {
    store(values, &rows[row][lane]);
  }
  HWY_INLINE void set_bounds(std::size_t lane, const SeenBounds& bounds) {
    set(kLowU, lane, bounds.low_u);
    set(kHighU, lane, bounds.high_u);
    set(kLowV, lane, bounds.low_v);
    set(kHighV, lane, bounds.high_v);
    set(kLowW, lane, bounds.low_w);
    set(kHighW, lane, bounds.high_w);
  }
  void set_seen_everywhere(std::size_t shape) {
    for (const Row row : {kLowU, kLowV, kLowW}) rows[row][shape] = -kAtApex;
    for (const Row row : {kHighU, kHighV, kHighW}) rows[row][shape] = kAtApex;
  }
};

/// Bounds of all rays that may still be hit.
struct PencilBounds {
  float low_u, high_u, low_v, high_v;
  float least_w;        ///< nothing with a smaller w matters
  float most_origin_w;  ///< nothing with a larger w matters
};

/// Triangles of a meshlet.
///
/// Seen from the apex, a ray's origin o lies before a triangle's plane by n.(u, v, 1) - w n.p,
/// where n is the normal and p a corner. In units of e = 2^-24, and with |x| for the sum of the
/// absolute values of x's components, the error of this value in float is at most
/// - 4 (|n.x| + |n.y|) from the places u and v, with four roundings of e each, and 3 |n| from the
///   sums: 7 |n|;
/// - 4 from the distance n.p, 2 from w and 3 from the sums: 9 w (|n.x p.x| + |n.y p.y| + |n.z
///   p.z|);
/// - 4 L^2 from each component of n, L being the longest side at the corner p, times o - p, which
///   for a hit is within sqrt(3) L: 7 w L^3. Within this slack, rounded up, the canonical test
///   decides (`PencilTests`). Beyond it, the sign is that of the canonical test, and so is that of
///   t: the apex lies on the other side of the plane.
///
/// For rays away from the apex, u and v are those of the direction. Their origins are off the line
/// through the apex by up to 16 e (scene size + distance) (`RayBatch`), where distance * w is at
/// most sqrt(3). The slack grows by this distance, times the sum of the absolute values of n's
/// components.
template <class Policy>
class TriangleShapes {
 public:
  TriangleShapes(const Meshlet& meshlet, const ApexView& view, SeenShapes& shapes)
      : meshlet_(&meshlet), view_(&view), shapes_(&shapes) {}

  HWY_INLINE void operator()(const PencilBounds& within) {
    project();
    shapes_->present = shapes_->exact = shapes_->by_rays = shapes_->around = 0;
    for (std::size_t lane = 0; lane < meshlet_->triangle_count; lane += kLanes) {
      set_up(lane, within);
    }
    shapes_->present &= LaneBits{0xFFFFFFFF} >> (32U - meshlet_->triangle_count);
    shapes_->exact &= shapes_->present;
    for (LaneBits left = shapes_->exact; left != 0; left &= left - 1) {
      set_up_exactly(static_cast<std::size_t>(std::countr_zero(left)));
    }
  }

 private:
  HWY_INLINE void project() {
    for (std::size_t i = 0; i < meshlet_->vertex_count; i += kLanes) {
      const Points at =
          view_->turned(load(&meshlet_->vertices[0][i]), load(&meshlet_->vertices[1][i]),
                        load(&meshlet_->vertices[2][i]));
      store(at.x, &x_[i]);
      store(at.y, &y_[i]);
      store(at.z, &z_[i]);
      const Points seen = view_->from_apex(at);
      const Floats w = hn::Div(all(1.0F), seen.z);
      store(hn::Mul(seen.x, w), &u_[i]);
      store(hn::Mul(seen.y, w), &v_[i]);
      // A corner next to or behind the apex has no accurate place; its w is set to NaN.
      const Mask before =
          hn::Gt(hn::Mul(seen.z, all(kFarAside)), hn::Max(hn::Abs(seen.x), hn::Abs(seen.y)));
      store(hn::IfThenElse(before, w, all(kNaN)), &w_[i]);
    }
  }

  HWY_INLINE void set_up(std::size_t lane, const PencilBounds& within) {
    const hn::Rebind<std::uint8_t, Tag> bytes;
    std::array<Ints, 3> index;
    for (std::size_t k = 0; k < 3; ++k) {
      index[k] = hn::PromoteTo(IntTag(), hn::LoadU(bytes, meshlet_->corners[k].data() + lane));
    }
    const auto corner = [&](const std::array<float, Meshlet::kMaxVertices>& values,
                            std::size_t which) { return Table32(values.data()).at(index[which]); };
    const Floats w0 = corner(w_, 0), w1 = corner(w_, 1), w2 = corner(w_, 2);
    const Floats u0 = corner(u_, 0), u1 = corner(u_, 1), u2 = corner(u_, 2);
    const Floats v0 = corner(v_, 0), v1 = corner(v_, 1), v2 = corner(v_, 2);
    const SeenBounds bounds{hn::Min(u0, hn::Min(u1, u2)), hn::Max(u0, hn::Max(u1, u2)),
                            hn::Min(v0, hn::Min(v1, v2)), hn::Max(v0, hn::Max(v1, v2)),
                            hn::Min(w0, hn::Min(w1, w2)), hn::Max(w0, hn::Max(w1, w2))};
    const Floats sum = hn::Add(w0, hn::Add(w1, w2));
    const Mask before = hn::Eq(sum, sum);
    const Floats nearer = hn::Sub(bounds.high_w, all(within.least_w));
    const SeenBounds wider = widened<Policy>(bounds, hn::Mul(nearer, all(view_->spread)));
    const Floats outside = either(
        either(hn::Sub(wider.high_u, all(within.low_u)), hn::Sub(all(within.high_u), wider.low_u),
               hn::Sub(wider.high_v, all(within.low_v))),
        hn::Sub(all(within.high_v), wider.low_v),
        either(nearer, hn::Sub(all(within.most_origin_w), bounds.low_w), hn::Zero(Tag())));
    const Mask present = hn::Or(hn::Not(before), hn::Not(is_negative(outside)));
    if (hn::AllFalse(Tag(), present)) return;

    // Sides are computed from the corners themselves: seen from a distant apex, these are rounded
    // too coarsely for a small triangle's normal.
    const Points first{corner(x_, 0), corner(y_, 0), corner(z_, 0)};
    const Points p0 = view_->from_apex(first);
    const auto side = [&](std::size_t which) -> Points {
      return {hn::Sub(corner(x_, which), first.x), hn::Sub(corner(y_, which), first.y),
              hn::Sub(corner(z_, which), first.z)};
    };
    const Points side1 = side(1);
    const Points side2 = side(2);
    const Points normal{hn::MulSub(side1.y, side2.z, hn::Mul(side1.z, side2.y)),
                        hn::MulSub(side1.z, side2.x, hn::Mul(side1.x, side2.z)),
                        hn::MulSub(side1.x, side2.y, hn::Mul(side1.y, side2.x))};
    const Points size{hn::Abs(normal.x), hn::Abs(normal.y), hn::Abs(normal.z)};
    const Floats distance = dot(normal, p0);
    // A needle triangle's normal is too inaccurate in float unless the needle is small.
    const Floats longest = hn::Max(dot(side1, side1), dot(side2, side2));
    const float reach = 4.0F * view_->scene_size;
    const Mask needle = hn::Not(hn::Lt(hn::Mul(longest, hn::Mul(longest, longest)),
                                       hn::Mul(all(reach * reach), dot(normal, normal))));
    const Points p0_size{hn::Abs(p0.x), hn::Abs(p0.y), hn::Abs(p0.z)};
    const Floats sum_of_sizes = hn::Add(size.x, hn::Add(size.y, size.z));
    const Floats slack = hn::Mul(all(kRounding * kSlackOfPlaces<Policy>), sum_of_sizes);
    Floats slack_per_w =
        hn::MulAdd(all(10.0F * kRounding), dot(size, p0_size),
                   hn::Mul(all(8.0F * kRounding), hn::Mul(longest, hn::Sqrt(longest))));
    slack_per_w = hn::MulAdd(all(kRounding * kSlackOfOrigins<Policy> * view_->scene_size),
                             sum_of_sizes, slack_per_w);

    // The places of corners are the same for all their triangles. So edges moved outward by their
    // rounding error leave no gap between triangles that share an edge or a corner.
    struct Edge {
      Floats a, b, c;
    };
    const auto edge = [&](Floats ui, Floats vi, Floats uj, Floats vj) -> Edge {
      const Floats a = hn::Sub(vi, vj);
      const Floats b = hn::Sub(uj, ui);
      const Floats c =
          hn::Mul(all(-0.5F), hn::Add(hn::Mul(a, hn::Add(ui, uj)), hn::Mul(b, hn::Add(vi, vj))));
      return {a, b, c};
    };
    const std::array<Edge, 3> edges{edge(u1, v1, u2, v2), edge(u2, v2, u0, v0),
                                    edge(u0, v0, u1, v1)};
    const Floats area = hn::Sub(hn::Mul(edges[1].a, edges[2].b), hn::Mul(edges[2].a, edges[1].b));
    const Floats extent =
        hn::Add(hn::Sub(bounds.high_u, bounds.low_u), hn::Sub(bounds.high_v, bounds.low_v));
    const Mask sliver = hn::Not(hn::Gt(hn::Abs(area), hn::Mul(extent, all(kSliver))));

    const Mask at_end = hn::Gt(hn::Mul(bounds.high_w, all(view_->end)), all(1.0F));
    shapes_->present |= bits_of(present) << lane;
    const Mask inexact = hn::Or(hn::Or(hn::Not(before), at_end), sliver);
    const Mask bounded = hn::AndNot(at_end, before);
    shapes_->set_bounds(lane, Policy::kHull ? anywhere_unless(bounded, bounds) : bounds);
    // For a bundle, uncertain edges and planes are set to zero, so that they exclude nothing. So is
    // the plane of a triangle that may be seen from both sides.
    const auto usable = [](Mask excluded, Floats value) {
      return Policy::kHull ? hn::IfThenZeroElse(excluded, value) : value;
    };
    const Floats turn = hn::And(area, all(-0.0F));
    Floats longest_edge = hn::Zero(Tag());
    for (std::size_t k = 0; k < 3; ++k) {
      const auto set = [&](std::size_t row, Floats value) {
        shapes_->set(row, lane, usable(inexact, value));
      };
      set(SeenShapes::kEdge0 + 3 * k, hn::Xor(edges[k].a, turn));
      set(SeenShapes::kEdge0 + 3 * k + 1, hn::Xor(edges[k].b, turn));
      const Floats size_a = hn::Abs(edges[k].a);
      const Floats size_b = hn::Abs(edges[k].b);
      const Floats length = hn::Add(size_a, size_b);
      longest_edge = hn::Max(longest_edge, length);
      set(SeenShapes::kEdge0 + 3 * k + 2,
          hn::MulAdd(all(kOutward), length, hn::Xor(edges[k].c, turn)));
      set(SeenShapes::kMagnitudes + 2 * k, size_a);
      set(SeenShapes::kMagnitudes + 2 * k + 1, size_b);
    }
    if (!Policy::kClosest) {
      shapes_->set(SeenShapes::kEdgeMargin, lane, hn::Mul(all(kUncertain), longest_edge));
    }
    const Floats reach_of_ball =
        hn::MulAdd(all(1.125F * view_->radius), hn::Sqrt(dot(normal, normal)), slack_per_w);
    const Mask around = hn::Or(needle, hn::Le(hn::Abs(distance), reach_of_ball));
    const Floats toward = hn::And(distance, all(-0.0F));
    const auto with = [](Floats value, Floats change) {
      return Policy::kClosest ? value : hn::Add(value, change);
    };
    const auto set = [&](std::size_t row, Floats value) {
      shapes_->set(row, lane, usable(around, value));
    };
    set(SeenShapes::kPlane, hn::Xor(normal.x, toward));
    set(SeenShapes::kPlane + 1, hn::Xor(normal.y, toward));
    set(SeenShapes::kPlane + 2, with(hn::Xor(normal.z, toward), slack));
    set(SeenShapes::kMagnitudes + 6, size.x);
    set(SeenShapes::kMagnitudes + 7, size.y);
    set(SeenShapes::kDistance, with(hn::Abs(distance), hn::Neg(slack_per_w)));
    shapes_->set(SeenShapes::kSlack, lane, with(slack, slack));
    shapes_->set(SeenShapes::kSlackPerW, lane, with(slack_per_w, slack_per_w));
    if (!Policy::kHull) shapes_->exact |= bits_of(hn::Or(inexact, needle)) << lane;
  }

  void set_up_exactly(std::size_t triangle) {
    SeenShapes& shapes = *shapes_;
    const LaneBits bit = LaneBits{1} << triangle;
    const auto exact =
        exact_apex_triangle(view_->apex, view_->side,
                            {meshlet_->corner(0, triangle), meshlet_->corner(1, triangle),
                             meshlet_->corner(2, triangle)});
    if (!exact) {
      shapes.present &= ~bit;
      shapes.exact &= ~bit;
      return;
    }
    shapes.set_seen_everywhere(triangle);
    if (exact->at_apex || exact->distance_to_plane <= double{view_->end}) {
      shapes.exact &= ~bit;
      shapes.by_rays |= bit;
      for (std::size_t row = SeenShapes::kEdge0; row < SeenShapes::kRows; ++row) {
        shapes.rows[row][triangle] = 0.0F;
      }
      return;
    }
    shapes.exact_triangle[triangle] = *exact;
    // Round to float for the tests of blocks, and move outward again.
    const auto set_bound = [&](SeenShapes::Row row, double bound, double more) {
      shapes.rows[row][triangle] = static_cast<float>(std::clamp(
          bound + more * std::max(1.0, std::abs(bound)), double{-kAtApex}, double{kAtApex}));
    };
    set_bound(SeenShapes::kLowU, exact->low.x, -1e-6);
    set_bound(SeenShapes::kHighU, exact->high.x, 1e-6);
    set_bound(SeenShapes::kLowV, exact->low.y, -1e-6);
    set_bound(SeenShapes::kHighV, exact->high.y, 1e-6);
    const auto set_line = [&](const glm::dvec3& line, std::size_t row, std::size_t magnitudes) {
      const glm::vec3 rounded(line);
      const float size = std::abs(rounded.x) + std::abs(rounded.y) + std::abs(rounded.z);
      shapes.rows[row][triangle] = rounded.x;
      shapes.rows[row + 1][triangle] = rounded.y;
      shapes.rows[row + 2][triangle] = rounded.z + 1e-6F * size;
      shapes.rows[magnitudes][triangle] = std::abs(rounded.x);
      shapes.rows[magnitudes + 1][triangle] = std::abs(rounded.y);
    };
    for (std::size_t k = 0; k < 3; ++k) {
      set_line(exact->edges[k], SeenShapes::kEdge0 + 3 * k, SeenShapes::kMagnitudes + 2 * k);
    }
    set_line(exact->plane, SeenShapes::kPlane, SeenShapes::kMagnitudes + 6);
    shapes.rows[SeenShapes::kDistance][triangle] =
        static_cast<float>(exact->distance * (1.0 - 1e-6));
  }

  static constexpr float kRounding = 0x1p-24F;
  /// The distance by which edges are moved outward on the side of the cube: a rounding of places
  /// |u| <= 1.
  static constexpr float kOutward = kRounding;
  /// The distance from a moved edge within which hits of any-hit queries are uncertain: the errors
  /// of places and edges are smaller, but far from the apex they exceed the tolerance of ray and
  /// hit (`float_unit`).
  static constexpr float kUncertain = 8.0F * kRounding;
  /// The tangent beyond which a corner's place is less accurate than the bounds of blocks allow.
  static constexpr float kFarAside = 4.0F;
  /// The area of a triangle, over its extent, below which its sign is uncertain: eight roundings of
  /// places up to `kFarAside`.
  static constexpr float kSliver = 0x1p-18F;

  const Meshlet* meshlet_;
  const ApexView* view_;
  SeenShapes* shapes_;
  alignas(64) std::array<float, Meshlet::kMaxVertices> x_, y_, z_, u_, v_, w_;
};

/// Sets up the spheres of a block.
template <class Policy>
HWY_INLINE void set_up_spheres(const SphereBlock& block, const ApexView& view, float slack,
                               SeenShapes& shapes) {
  shapes.present = shapes.exact = shapes.by_rays = shapes.around = 0;
  for (std::size_t lane = 0; lane < block.count; lane += kLanes) {
    const Points center = view.from_apex(view.turned(
        load(&block.center[0][lane]), load(&block.center[1][lane]), load(&block.center[2][lane])));
    const Floats radius = load(&block.radius[lane]);
    const Floats wider = hn::MulAdd(radius, all(1.0F + 0x1p-20F), all(slack));
    const Floats near_z = hn::Sub(center.z, wider);
    const Floats far_z = hn::Add(center.z, wider);
    const Extent u = tangents(center.x, center.z, wider);
    const Extent v = tangents(center.y, center.z, wider);
    const Mask before = hn::Gt(
        near_z, hn::Max(hn::Mul(wider, all(0x1p-10F)), all(Policy::kHull ? view.end : 0.0F)));
    const auto clip = [&](Floats value, float otherwise) {
      return hn::IfThenElse(before, value, all(otherwise));
    };
    constexpr float kSlack = 0x1p-20F;
    shapes.set_bounds(
        lane,
        {clip(hn::Sub(u.low, all(kSlack)), -kAtApex), clip(hn::Add(u.high, all(kSlack)), kAtApex),
         clip(hn::Sub(v.low, all(kSlack)), -kAtApex), clip(hn::Add(v.high, all(kSlack)), kAtApex),
         clip(hn::Div(all(1.0F), far_z), -kAtApex), clip(hn::Div(all(1.0F), near_z), kAtApex)});
    shapes.set(SeenShapes::kCenter, lane, center.x);
    shapes.set(SeenShapes::kCenter + 1, lane, center.y);
    shapes.set(SeenShapes::kCenter + 2, lane, center.z);
    shapes.set(SeenShapes::kRadius, lane, radius);
    shapes.present |= bits_of(hn::Gt(far_z, all(-1.001F * view.radius))) << lane;
    if constexpr (Policy::kHull) continue;
    const Floats squared = dot(center, center);
    const Floats radius_squared = hn::Mul(radius, radius);
    shapes.around |= bits_of(hn::Lt(squared, radius_squared)) << lane;
    // If the surface is very close, float cannot decide on which side of it the apex is, nor which
    // rays end before it.
    const Floats near =
        hn::MulAdd(all(0x1p-19F), hn::Add(squared, radius_squared),
                   hn::Mul(all(view.end), hn::MulAdd(all(2.0F), radius, all(view.end))));
    const Mask at_apex = hn::Le(hn::Abs(hn::Sub(squared, radius_squared)), near);
    shapes.by_rays |= bits_of(at_apex) << lane;
  }
  shapes.present &= (LaneBits{1} << block.count) - 1;
}

/// Sets up the cones of a block: their boxes; rays decide.
template <class Policy>
HWY_INLINE void set_up_cones(const ConeBlock& block, const ApexView& view, SeenShapes& shapes) {
  shapes.present = shapes.exact = shapes.around = 0;
  for (std::size_t lane = 0; lane < block.count; lane += kLanes) {
    Mask seen;
    shapes.set_bounds(lane, bounds_of<Policy>(block.boxes, lane, view, seen));
    shapes.present |= bits_of(seen) << lane;
  }
  shapes.present &= (LaneBits{1} << block.count) - 1;
  shapes.by_rays = shapes.present;
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

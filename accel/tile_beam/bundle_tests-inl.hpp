// Tests the origins of a block against a leaf's shape for all apexes of a bundle at once.

#if defined(ACCEL_TILE_BEAM_BUNDLE_TESTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_BUNDLE_TESTS_INL
#undef ACCEL_TILE_BEAM_BUNDLE_TESTS_INL
#else
#define ACCEL_TILE_BEAM_BUNDLE_TESTS_INL
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "accel/core/intersect.hpp"
#include "accel/tile_beam/pencil_groups-inl.hpp"
#include "accel/tile_beam/pencil_shapes-inl.hpp"
#include "accel/tile_beam/pencil_unit.hpp"
#include "accel/tile_beam/shape_values-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Tests pairs of a block and a shape, as PencilTests does for one apex: hides apexes from origins,
/// and ends origins from which all apexes are hidden or that are left open. Each function returns
/// the groups that changed.
class BundleTests {
 public:
  BundleTests(const PencilPart& part, PencilUnit& unit, PencilGroups<HullPolicy>& groups,
              const SeenShapes& shapes, const ApexView& view)
      : part_(&part), unit_(&unit), groups_(&groups), shapes_(&shapes), view_(&view) {}

  HWY_INLINE std::uint32_t test_triangles(std::span<const std::uint32_t> pairs,
                                          const Meshlet& meshlet) {
    return test_each(pairs, [&](std::size_t place, std::size_t shape) {
      return test_triangle(place, shape, meshlet);
    });
  }
  HWY_INLINE std::uint32_t test_spheres(std::span<const std::uint32_t> pairs, const SphereBlock&) {
    return test_each(
        pairs, [&](std::size_t place, std::size_t shape) { return test_sphere(place, shape); });
  }
  /// Leaves open all origins next to a cone.
  HWY_INLINE std::uint32_t test_cones(std::span<const std::uint32_t> pairs, const ConeBlock&) {
    return test_each(pairs,
                     [&](std::size_t place, std::size_t) { return LaneBits{unit_->alive[place]}; });
  }

 private:
  /// Calls `test(place, shape)` for each pair; it returns the origins that end.
  template <class Test>
  HWY_INLINE std::uint32_t test_each(std::span<const std::uint32_t> pairs, Test test) {
    std::uint32_t changed = 0;
    for (const std::uint32_t pair : pairs) {
      const std::size_t place = pair / SeenShapes::kMax;
      changed |= groups_->note(place, test(place, pair % SeenShapes::kMax));
    }
    return changed;
  }

  /// Hides all apexes from origins of a block.
  HWY_INLINE void hide(std::size_t place, LaneBits lanes) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
      unit_->hidden[place * PencilUnit::kBlock + lane] =
          static_cast<std::uint16_t>(part_->bundle->all_apexes());
    }
  }

  /// Tests a triangle for the origins of a block. Returns the origins from which all apexes are
  /// hidden.
  ///
  /// Edges are also moved by the errors of places and edges; the plane is moved by its slack.
  HWY_INLINE LaneBits test_triangle(std::size_t place, std::size_t shape, const Meshlet& meshlet) {
    constexpr float kUncertain = 8.0F * 0x1p-24F;
    const OneShape of{*shapes_, shape};
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    LaneBits behind = 0;
    LaneBits covered = 0;
    LaneBits possible = for_each_register([&](std::size_t lane) {
      const Floats u = load(&unit_->u[block + lane]);
      const Floats v = load(&unit_->v[block + lane]);
      const Floats w = load(&unit_->w[block + lane]);
      const Floats nearer = hn::Max(hn::Sub(of(SeenShapes::kHighW), w), hn::Zero(Tag()));
      const Floats more = hn::MulAdd(nearer, all(1.001F * view_->spread), all(kUncertain));
      const Edges edges = edges_of(of, u, v);
      const auto wider = [&](std::size_t k) {
        const Floats length =
            hn::Add(of(SeenShapes::kMagnitudes + 2 * k), of(SeenShapes::kMagnitudes + 2 * k + 1));
        return hn::Mul(length, more);
      };
      const std::array<Floats, 3> by{wider(0), wider(1), wider(2)};
      const Floats beyond = beyond_plane(of, u, v, w);
      const Floats missed = hn::Or(
          either(hn::Add(edges[0], by[0]), hn::Add(edges[1], by[1]), hn::Add(edges[2], by[2])),
          beyond);
      // Edges and planes that are zero neither exclude nor decide anything.
      const auto inside = [&](std::size_t k) { return hn::Gt(edges[k], hn::Add(by[k], by[k])); };
      covered |= bits_of(hn::And(hn::And(inside(0), inside(1)), inside(2))) << lane;
      behind |= bits_of(hn::Gt(beyond, slack_of(of, w))) << lane;
      return hn::Not(is_negative(missed));
    });
    possible &= unit_->alive[place];
    if (possible == 0) return 0;
    // A triangle that may be seen from both sides covers nothing, since its plane is 0.
    covered = view_->ends_at_apex ? covered & possible & behind : 0;
    hide(place, covered);
    const LaneBits others = possible & ~covered;
    return covered | (others == 0 ? 0 : hide_apexes(place, others, shape, meshlet));
  }

  /// The maximum number of triangles tested for all apexes of an origin. With more triangles,
  /// streams are faster.
  static constexpr std::uint8_t kMostTests = 64;

  /// Finds the apexes that a triangle hides from some origins of a block. Returns the origins that
  /// end here: all apexes are hidden, or there were too many tests.
  ///
  /// Let P be an origin, A, B and C the corners relative to it, n the normal and d the vector to an
  /// apex. The triangle hides the apex if P and the apex are on opposite sides of its plane, and d
  /// . (A x B), d . (B x C) and d . (C x A) all have the sign of the apex's side.
  ///
  /// Origins, corners and apexes are floats, so the components of A, B, C and d in float have a
  /// relative error of e (= 2^-24). The ray's direction may differ by as much, and by e S, because
  /// its origin, with coordinates of at most S, was rounded. Let m be the longest of A, B and C.
  /// The error of a cross product is 6 e m^2, and that of its product with d is e m^2 (18 |d| + 2
  /// S). For a point at a distance l from a corner, the height over the plane times |n| has an
  /// error of e l (9 L^2 + 5 |n|), L being the longest side. Rays end before an apex by
  /// `surface_lift`. Within these errors, which are rounded up, the canonical test decides.
  HWY_NOINLINE LaneBits hide_apexes(std::size_t place, LaneBits origins, std::size_t shape,
                                    const Meshlet& meshlet) {
    constexpr float kRounding = 0x1p-24F;
    constexpr float kTiny = 1e-30F;    // numbers that underflow are smaller than its rounding error
    constexpr float kLift = 0x1p-17F;  // twice that of `surface_lift`
    const BundleRays& bundle = *part_->bundle;
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    std::array<glm::vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = meshlet.corner(k, shape);
    const glm::vec3 side_1 = corners[1] - corners[0];
    const glm::vec3 side_2 = corners[2] - corners[0];
    const glm::vec3 normal = glm::cross(side_1, side_2);
    const Points upward = all_of(normal);
    const float length = glm::length(normal);
    const float wrong_per_distance =
        16.0F * kRounding *
        (std::max(glm::dot(side_1, side_1), glm::dot(side_2, side_2)) + length + kTiny);
    const float wrong_of_apex =
        wrong_per_distance * (glm::distance(corners[0], view_->apex) + view_->radius);
    const glm::vec3 apex_size = glm::abs(view_->apex);
    const float coordinates =
        2.0F * std::max({view_->scene_size, apex_size.x, apex_size.y, apex_size.z});
    struct Row {
      alignas(64) std::array<float, PencilUnit::kBlock> at;
    };
    // Three normals, the origin, and the error bounds of products and of the apexes' heights.
    enum : std::size_t { kNormals = 0, kOrigin = 9, kProduct = 12, kHeight = 13, kRows = 14 };
    std::array<Row, kRows> rows;
    for (LaneBits left = unit_->lanes[unit_->slot[place]]; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      const glm::vec3& origin = part_->rays[unit_->ray_at(block + lane)].origin;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        rows[kOrigin + axis].at[lane] = origin[static_cast<int>(axis)];
      }
    }
    LaneBits above = 0;
    LaneBits beside = 0;  // may lie in the plane
    for (std::size_t lane = 0; lane < PencilUnit::kBlock; lane += kLanes) {
      const Points origin{load(&rows[kOrigin].at[lane]), load(&rows[kOrigin + 1].at[lane]),
                          load(&rows[kOrigin + 2].at[lane])};
      const auto from_origin = [&](const glm::vec3& corner) -> Points {
        return {hn::Sub(all(corner.x), origin.x), hn::Sub(all(corner.y), origin.y),
                hn::Sub(all(corner.z), origin.z)};
      };
      const Points a = from_origin(corners[0]);
      const Points b = from_origin(corners[1]);
      const Points c = from_origin(corners[2]);
      const Floats square = hn::Max(dot(a, a), hn::Max(dot(b, b), dot(c, c)));
      const Floats over = hn::Neg(dot(a, upward));
      const Floats wrong = hn::Mul(hn::Sqrt(square), all(wrong_per_distance));
      const Mask is_above = hn::Gt(over, hn::Zero(Tag()));
      above |= bits_of(is_above) << lane;
      beside |= bits_of(hn::Not(hn::Gt(hn::Abs(over), wrong))) << lane;
      // d . n has the sign of the apex's side, which is the opposite of the origin's.
      const Floats turn = hn::IfThenElseZero(is_above, all(-0.0F));
      const auto set_normal = [&](std::size_t row, const Points& p, const Points& q) {
        const auto set = [&](std::size_t axis, Floats value) {
          store(hn::Xor(value, turn), &rows[row + axis].at[lane]);
        };
        set(0, hn::MulSub(p.y, q.z, hn::Mul(p.z, q.y)));
        set(1, hn::MulSub(p.z, q.x, hn::Mul(p.x, q.z)));
        set(2, hn::MulSub(p.x, q.y, hn::Mul(p.y, q.x)));
      };
      set_normal(kNormals, a, b);
      set_normal(kNormals + 3, b, c);
      set_normal(kNormals + 6, c, a);
      // |d| <= sqrt(3) z + r <= 3 z
      const Floats z = hn::Div(all(1.0F), load(&unit_->w[block + lane]));
      store(hn::Mul(hn::Mul(hn::Add(square, all(kTiny)), all(kRounding)),
                    hn::MulAdd(z, all(60.0F), all(2.0F * coordinates))),
            &rows[kProduct].at[lane]);
      store(hn::MulAdd(hn::MulAdd(z, all(3.0F), all(2.0F * coordinates)), all(kLift * length),
                       all(wrong_of_apex)),
            &rows[kHeight].at[lane]);
    }
    const LaneBits every = bundle.all_apexes();
    LaneBits ended = 0;
    for (; origins != 0; origins &= origins - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(origins));
      const auto of = [&](std::size_t row) { return all(rows[row].at[lane]); };
      const bool is_beside = (beside >> lane & 1U) != 0;
      const Floats sign = all((above >> lane & 1U) != 0 ? -0.0F : 0.0F);
      LaneBits hits = 0;
      LaneBits doubts = 0;
      for (std::size_t i = 0; i < BundleRays::kApexes; i += kLanes) {
        const Points apex{load(&bundle.places[0][i]), load(&bundle.places[1][i]),
                          load(&bundle.places[2][i])};
        const Points along{hn::Sub(apex.x, of(kOrigin)), hn::Sub(apex.y, of(kOrigin + 1)),
                           hn::Sub(apex.z, of(kOrigin + 2))};
        const auto product = [&](std::size_t row) {
          return dot(along, Points{of(row), of(row + 1), of(row + 2)});
        };
        const Floats first = product(kNormals);
        const Floats second = product(kNormals + 3);
        const Floats third = product(kNormals + 6);
        const Floats least = hn::Min(hn::Min(first, second), third);
        // Above the plane, on the side opposite the origin.
        const Floats height =
            dot(Points{hn::Sub(apex.x, all(corners[0].x)), hn::Sub(apex.y, all(corners[0].y)),
                       hn::Sub(apex.z, all(corners[0].z))},
                upward);
        const Floats beyond = hn::Xor(height, sign);
        const Mask inside = hn::Gt(least, of(kProduct));
        Mask possible = hn::Ge(least, hn::Neg(of(kProduct)));
        if (is_beside) {
          const Floats most = hn::Max(hn::Max(first, second), third);
          possible = hn::Or(possible, hn::Le(most, of(kProduct)));
          doubts |= bits_of(possible) << i;
          continue;
        }
        const Mask opposite = hn::Gt(beyond, of(kHeight));
        const Mask same = hn::Lt(beyond, hn::Neg(of(kHeight)));
        const Mask hit = hn::And(inside, opposite);
        hits |= bits_of(hit) << i;
        doubts |= bits_of(hn::AndNot(hit, hn::AndNot(same, possible))) << i;
      }
      std::uint16_t& hidden = unit_->hidden[place * PencilUnit::kBlock + lane];
      doubts &= every & ~LaneBits{hidden};
      for (; doubts != 0; doubts &= doubts - 1) {
        const auto apex = static_cast<std::size_t>(std::countr_zero(doubts));
        const Ray& ray = bundle.ray(unit_->ray_at(block + lane), apex);
        const float t = intersect_triangle(CanonicalRay(ray), meshlet.corner(0, shape),
                                           meshlet.corner(1, shape), meshlet.corner(2, shape));
        hits |= LaneBits{accel::is_hit(t)} << apex;
      }
      hidden = static_cast<std::uint16_t>(hidden | (hits & every));
      std::uint8_t& tests = unit_->tests[place * PencilUnit::kBlock + lane];
      ended |= LaneBits{hidden == every || ++tests == kMostTests} << lane;
    }
    return ended;
  }

  /// Returns the origins from which a sphere may hide an apex. First hides all apexes from the
  /// origins from which the sphere certainly covers the whole light. At a fraction s of the way,
  /// the line from an origin to an apex is at most s times the ball's radius away from the line to
  /// the center. A ray misses the sphere if it begins outside and moves away from it.
  HWY_INLINE LaneBits test_sphere(std::size_t place, std::size_t shape) {
    const OneShape of{*shapes_, shape};
    const Points center{of(SeenShapes::kCenter), of(SeenShapes::kCenter + 1),
                        of(SeenShapes::kCenter + 2)};
    const Floats radius = of(SeenShapes::kRadius);
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    const Floats ball = all(1.001F * view_->radius);
    const Floats high_w = of(SeenShapes::kHighW);
    LaneBits covered = 0;
    const LaneBits possible = for_each_register([&](std::size_t lane) {
      const std::size_t at = block + lane;
      const Points direction{load(&unit_->u[at]), load(&unit_->v[at]), all(1.0F)};
      const Floats w = load(&unit_->w[at]);
      const Floats origin = hn::Div(all(1.0F), w);
      const Floats slack =
          hn::MulAdd(all(0x1p-19F), hn::Add(origin, radius), all(0x1p-20F * view_->scene_size));
      const auto from_center = [&](Floats s) -> Points {
        return {hn::MulSub(direction.x, s, center.x), hn::MulSub(direction.y, s, center.y),
                hn::Sub(s, center.z)};
      };
      const Points begin = from_center(origin);
      const Floats far = hn::Sqrt(dot(begin, begin));
      const Mask outside = hn::Gt(far, hn::Add(radius, slack));
      const Floats length = hn::Mul(origin, hn::Sqrt(dot(direction, direction)));
      // (center of the ball - origin) . (origin - center of the sphere)
      const Floats away = hn::Neg(hn::Mul(origin, dot(direction, begin)));
      const Mask leaves =
          hn::And(hn::Gt(far, hn::MulAdd(radius, all(0x1p-22F), radius)),
                  hn::Gt(away, hn::Mul(hn::MulAdd(all(0x1p-20F), length, ball), far)));
      const Floats middle = hn::Div(dot(direction, center), dot(direction, direction));
      const Floats nearest_at = hn::Max(hn::Min(middle, origin), hn::Zero(Tag()));
      const Points nearest = from_center(nearest_at);
      const Floats distance = hn::Sqrt(dot(nearest, nearest));
      // The largest fraction of the way at which the sphere may be met.
      const Floats near_z = hn::Div(all(1.0F), high_w);
      const Floats last =
          hn::Min(hn::Div(hn::Sub(origin, near_z), hn::Sub(origin, ball)), all(1.0F));
      const Floats beside = hn::Mul(ball, hn::Max(last, hn::Zero(Tag())));
      const Mask met = hn::Not(hn::Gt(distance, hn::Add(hn::Add(radius, slack), beside)));
      if (view_->ends_at_apex) {
        const Floats share = hn::Sub(all(1.0F), hn::Mul(nearest_at, w));
        const Mask through = hn::Lt(hn::MulAdd(ball, share, hn::Add(distance, slack)), radius);
        const Mask bounded = hn::Lt(high_w, all(kAtApex));
        covered |= bits_of(hn::And(hn::And(through, outside), bounded)) << lane;
      }
      return hn::AndNot(leaves, met);
    });
    covered &= possible & unit_->alive[place];
    hide(place, covered);
    return possible & unit_->alive[place];
  }

  const PencilPart* part_;
  PencilUnit* unit_;
  PencilGroups<HullPolicy>* groups_;
  const SeenShapes* shapes_;
  const ApexView* view_;
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

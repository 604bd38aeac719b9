// Tests the rays of a block against a shape of a leaf.

#if defined(ACCEL_TILE_BEAM_PENCIL_TESTS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_PENCIL_TESTS_INL
#undef ACCEL_TILE_BEAM_PENCIL_TESTS_INL
#else
#define ACCEL_TILE_BEAM_PENCIL_TESTS_INL
#endif

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "accel/core/intersect.hpp"
#include "accel/tile_beam/pencil_groups-inl.hpp"
#include "accel/tile_beam/pencil_pairs-inl.hpp"
#include "accel/tile_beam/pencil_shapes-inl.hpp"
#include "accel/tile_beam/pencil_single_rays-inl.hpp"
#include "accel/tile_beam/pencil_unit.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Tests pairs of a block and a shape, and records the hits. Each function returns the groups that
/// changed.
template <class Policy, class Counting>
class PencilTests {
 public:
  PencilTests(const scenes::Scene& scene, const PencilPart& part, PencilUnit& unit,
              PencilGroups<Policy>& groups, PencilSingleRays<Policy, Counting>& single_rays,
              const SeenShapes& shapes, const ApexView& view)
      : scene_(&scene),
        part_(&part),
        unit_(&unit),
        groups_(&groups),
        single_rays_(&single_rays),
        shapes_(&shapes),
        view_(&view) {}

  HWY_INLINE std::uint32_t test_triangles(std::span<const std::uint32_t> pairs,
                                          const Meshlet& meshlet) {
    const LaneBits special = shapes_->exact | shapes_->by_rays;
    std::uint32_t changed = 0;  // in a register, because the next test would wait for it in memory
    for (const std::uint32_t pair : pairs) {
      const std::size_t place = pair / SeenShapes::kMax;
      const std::size_t shape = pair % SeenShapes::kMax;
      if constexpr (Policy::kHull) {
        changed |= groups_->note(place, triangle_of_bundle(place, shape, meshlet));
      } else if ((special >> shape & 1U) != 0) [[unlikely]] {
        changed |= test_specially(place, shape, meshlet);
      } else {
        LaneBits uncertain = 0;
        LaneBits hits = test_triangle(place, shape, meshlet.primitives[shape], uncertain);
        uncertain &= unit_->alive[place];
        if (uncertain != 0) [[unlikely]] {
          const Unsure unsure = told_apart(place, shape, uncertain);
          hits = decided_by_plane(place, hits, unsure.depth, meshlet, shape);
          hits = decided_by_rays(place, hits, unsure.edge);
        }
        changed |= groups_->note(place, hits);
      }
    }
    return changed;
  }

  HWY_INLINE std::uint32_t test_spheres(std::span<const std::uint32_t> pairs,
                                        const SphereBlock& block) {
    std::uint32_t changed = 0;
    for (const std::uint32_t pair : pairs) {
      const std::size_t place = pair / SeenShapes::kMax;
      const std::size_t shape = pair % SeenShapes::kMax;
      if constexpr (Policy::kHull) {
        changed |= groups_->note(place, sphere_of_bundle(place, shape));
        continue;
      }
      const scenes::PrimitiveId id = block.primitives[shape];
      const scenes::Sphere& sphere = scene_->spheres[scene_->primitives[id].index];
      const auto t_of = [&](const Ray& ray) {
        return leaves(sphere, ray) ? kMiss : intersect_sphere(CanonicalRay(ray), sphere);
      };
      if ((shapes_->by_rays >> shape & 1U) != 0) {
        changed |= test_by_rays(place, id, t_of);
      } else {
        const bool around = (shapes_->around >> shape & 1U) != 0;
        const bool inside_only = (block.inside_only >> shape & 1U) != 0;
        Unsure unsure;
        LaneBits hits = test_sphere(place, shape, around, inside_only, id, unsure);
        if (unsure.depth != 0) [[unlikely]] {
          hits = decided(place, hits, unsure.depth, id, t_of);
        }
        changed |= groups_->note(place, hits);
      }
    }
    return changed;
  }

  HWY_INLINE std::uint32_t test_cones(std::span<const std::uint32_t> pairs,
                                      const ConeBlock& block) {
    std::uint32_t changed = 0;
    for (const std::uint32_t pair : pairs) {
      if constexpr (Policy::kHull) {
        const std::size_t place = pair / SeenShapes::kMax;
        changed |= groups_->note(place, unit_->alive[place]);
        continue;
      }
      const scenes::PrimitiveId id = block.primitives[pair % SeenShapes::kMax];
      const scenes::Cone& cone = scene_->cones[scene_->primitives[id].index];
      changed |= test_by_rays(pair / SeenShapes::kMax, id, [&](const Ray& ray) {
        return intersect_cone(CanonicalRay(ray), cone);
      });
    }
    return changed;
  }

 private:
  static constexpr bool kClosest = Policy::kClosest;

  /// The rays of a block for which float cannot decide whether they hit a shape.
  struct Unsure {
    LaneBits depth = 0;  ///< they begin too close to it: at its surface or at one of its sides
    LaneBits edge = 0;   ///< hits close to an edge, which was moved outward
  };

  /// Hides all apexes from origins of a block.
  HWY_INLINE void hide(std::size_t place, LaneBits lanes) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
      unit_->hidden[place * PencilUnit::kBlock + lane] =
          static_cast<std::uint16_t>(part_->bundle->all_apexes());
    }
  }

  /// Tests a triangle for the origins of a block. Returns those from which all apexes are hidden.
  ///
  /// Edges are moved by what places and edges may be wrong, too; the plane is, by its slack.
  HWY_INLINE LaneBits triangle_of_bundle(std::size_t place, std::size_t shape,
                                         const Meshlet& meshlet) {
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
      // Zeros exclude nothing, and decide nothing.
      const auto inside = [&](std::size_t k) { return hn::Gt(edges[k], hn::Add(by[k], by[k])); };
      covered |= bits_of(hn::And(hn::And(inside(0), inside(1)), inside(2))) << lane;
      behind |= bits_of(hn::Gt(beyond, slack_of(of, w))) << lane;
      return hn::Not(is_negative(missed));
    });
    possible &= unit_->alive[place];
    if (possible == 0) return 0;
    // A triangle that may be seen from both sides covers nothing: its plane is 0.
    covered = view_->ends_at_apex ? covered & possible & behind : 0;
    hide(place, covered);
    const LaneBits others = possible & ~covered;
    return covered | (others == 0 ? 0 : hide_apexes(place, others, shape, meshlet));
  }

  /// The triangles that are tested for all apexes of an origin. For more, pencils take less time.
  static constexpr std::uint8_t kMostTests = 64;

  /// Finds the apexes that a triangle hides from some origins of a block. Returns the origins that
  /// end here: all apexes are hidden, or there were too many tests.
  ///
  /// Let P be an origin, A, B and C the corners relative to it, n the normal and d the vector to an
  /// apex. The triangle hides the apex if P and the apex are on two sides of its plane, and d . (A
  /// x B), d . (B x C) and d . (C x A) have one sign: that of the apex's side.
  ///
  /// Origins, corners and apexes are floats, so in float A, B, C and d are wrong by e (= 2^-24) of
  /// their components. The ray's direction may differ by as much, and by e S, because its origin
  /// was rounded, whose coordinates are at most S. Let m be the longest of A, B and C. A cross
  /// product is wrong by 6 e m^2, and one with d by e m^2 (18 |d| + 2 S). A height over the plane
  /// times |n|, of a point at a distance l from a corner, is wrong by e l (9 L^2 + 5 |n|), L being
  /// the longest side. Rays end before an apex by `surface_lift`. Within these errors, which are
  /// rounded up, the canonical test decides.
  HWY_NOINLINE LaneBits hide_apexes(std::size_t place, LaneBits origins, std::size_t shape,
                                    const Meshlet& meshlet) {
    constexpr float kRounding = 0x1p-24F;
    constexpr float kTiny = 1e-30F;    // what underflows is less than a rounding of that
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
    // Three normals, the origin, the possible errors of products and of the apexes' heights.
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
    LaneBits beside = 0;  // in the plane, perhaps
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
        // Above the plane, on the side opposite to the origin.
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

  /// Of a line from an origin to an apex, the point at the share s of the way lies beside that of
  /// the line to the center by at most s times the ball's radius. A ray that begins outside of the
  /// sphere and moves away from it misses it.
  HWY_INLINE LaneBits sphere_of_bundle(std::size_t place, std::size_t shape) {
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
      // The largest share of the way at which the sphere may be met.
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

  /// Returns the rays of a block that hit a triangle, and which of these hits are `uncertain`.
  /// These are so few that `told_apart` determines the reason.
  HWY_INLINE LaneBits test_triangle(std::size_t place, std::size_t shape,
                                    scenes::PrimitiveId primitive, LaneBits& uncertain) {
    const OneShape of{*shapes_, shape};
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    return for_each_register([&](std::size_t lane) {
      const Floats u = load(&unit_->u[block + lane]);
      const Floats v = load(&unit_->v[block + lane]);
      const Floats w = load(&unit_->w[block + lane]);
      const Edges edges = edges_of(of, u, v);
      const Floats outside = either(edges[0], edges[1], edges[2]);
      if constexpr (kClosest) {
        const Floats distance = of(SeenShapes::kDistance);
        const Floats plane = value_of(of, SeenShapes::kPlane, u, v, of(SeenShapes::kPlane + 2));
        const Floats before = hn::NegMulAdd(distance, w, plane);
        const Mask met =
            hn::AndNot(is_negative(hn::Or(outside, before)), lanes_of(unit_->alive[place], lane));
        if (hn::AllFalse(Tag(), met)) return met;
        const Floats origin_w = load(&unit_->origin_w[block + lane]);
        const Floats after = hn::MulSub(distance, origin_w, plane);
        const Floats may_err = slack_of(of, origin_w);
        const Mask possible = hn::AndNot(is_negative(hn::Add(after, may_err)), met);
        const Mask close = hn::And(possible, is_negative(hn::Sub(after, may_err)));
        uncertain |= bits_of(close) << lane;
        const Mask hit = hn::AndNot(close, possible);
        if (!hn::AllFalse(Tag(), hit)) {
          keep(block + lane, hit, hn::Div(plane, distance), w, primitive);
        }
        return hit;
      } else {
        const Floats beyond = beyond_plane(of, u, v, w);
        const Floats missed = hn::Or(outside, beyond);
        const Mask hit = hn::Not(is_negative(missed));
        const Floats clear = hn::Or(hn::Sub(beyond, slack_of(of, w)),
                                    hn::Sub(least_edge(edges), of(SeenShapes::kEdgeMargin)));
        uncertain |= bits_of(is_negative(hn::AndNot(missed, clear))) << lane;
        return hit;
      }
    });
  }

  /// Returns the possible error of a ray origin's place relative to a triangle's plane.
  static HWY_INLINE Floats slack_of(const OneShape& of, Floats w) {
    return hn::MulAdd(of(SeenShapes::kSlackPerW), w, of(SeenShapes::kSlack));
  }

  using Edges = std::array<Floats, 3>;

  static HWY_INLINE Floats value_of(const OneShape& of, std::size_t row, Floats u, Floats v,
                                    Floats constant) {
    return hn::MulAdd(of(row), u, hn::MulAdd(of(row + 1), v, constant));
  }
  static HWY_INLINE Edges edges_of(const OneShape& of, Floats u, Floats v) {
    const auto edge = [&](std::size_t row) { return value_of(of, row, u, v, of(row + 2)); };
    return {edge(SeenShapes::kEdge0), edge(SeenShapes::kEdge0 + 3), edge(SeenShapes::kEdge0 + 6)};
  }
  static HWY_INLINE Floats least_edge(const Edges& edges) {
    return hn::Min(edges[0], hn::Min(edges[1], edges[2]));
  }
  /// Returns how far behind a triangle's plane a ray begins, seen from the apex. For any hits.
  static HWY_INLINE Floats beyond_plane(const OneShape& of, Floats u, Floats v, Floats w) {
    return value_of(of, SeenShapes::kPlane, u, v,
                    hn::NegMulAdd(of(SeenShapes::kDistance), w, of(SeenShapes::kPlane + 2)));
  }

  /// Divides uncertain hits into those uncertain in depth and, for any hits, those at an edge.
  Unsure told_apart(std::size_t place, std::size_t shape, LaneBits uncertain) const {
    if constexpr (kClosest) return {uncertain, 0};
    const OneShape of{*shapes_, shape};
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    LaneBits in_depth = 0;
    LaneBits at_edge = 0;
    for (std::size_t lane = 0; lane < PencilUnit::kBlock; lane += kLanes) {
      const Floats u = load(&unit_->u[block + lane]);
      const Floats v = load(&unit_->v[block + lane]);
      const Floats w = load(&unit_->w[block + lane]);
      const Floats depth = hn::Sub(beyond_plane(of, u, v, w), slack_of(of, w));
      const Floats edge = hn::Sub(least_edge(edges_of(of, u, v)), of(SeenShapes::kEdgeMargin));
      in_depth |= bits_of(is_negative(depth)) << lane;
      at_edge |= bits_of(is_negative(edge)) << lane;
    }
    return {uncertain & in_depth, uncertain & at_edge};
  }

  /// Returns any hits, with those at an edge decided by single rays through the whole hierarchy: if
  /// triangles share the edge, another test of only one of them could lose the ray between them.
  LaneBits decided_by_rays(std::size_t place, LaneBits hits, LaneBits unsure) {
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    for (LaneBits left = hits & unsure; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      if (!single_rays_->is_hit(block + lane)) hits &= ~(LaneBits{1} << lane);
    }
    return hits;
  }

  /// Tests a triangle for which float is too coarse.
  std::uint32_t test_specially(std::size_t place, std::size_t shape, const Meshlet& meshlet) {
    const scenes::PrimitiveId primitive = meshlet.primitives[shape];
    if ((shapes_->exact >> shape & 1U) == 0) {
      return test_by_rays(place, primitive, [&](const Ray& ray) {
        return intersect_triangle(CanonicalRay(ray), meshlet.corner(0, shape),
                                  meshlet.corner(1, shape), meshlet.corner(2, shape));
      });
    }
    Unsure unsure;
    LaneBits hits = test_exact_triangle(place, shapes_->exact_triangle[shape], primitive, unsure);
    if (unsure.depth != 0) hits = decided_by_plane(place, hits, unsure.depth, meshlet, shape);
    // Seen edge-on, a sliver is no wider than the shift of its edges.
    if (!kClosest) hits = decided_by_rays(place, hits, unsure.edge);
    return groups_->note(place, hits);
  }

  /// Returns the hits of a block after a triangle's plane has decided in double on which side
  /// uncertain rays begin. The triangle's edges stay as tested in float: neighbors that share an
  /// edge must be tested in the same way, or a ray could pass between them.
  LaneBits decided_by_plane(std::size_t place, LaneBits hits, LaneBits unsure,
                            const Meshlet& meshlet, std::size_t shape) {
    const TrianglePlane plane(
        {meshlet.corner(0, shape), meshlet.corner(1, shape), meshlet.corner(2, shape)});
    return decided(place, hits, unsure, meshlet.primitives[shape],
                   [&](const Ray& ray) { return plane.hit(ray); });
  }

  /// Returns whether the ray begins outside of the sphere, clearly in double, and moves away from
  /// it. Far from the apex, most rays that begin beside a sphere are uncertain, and do so.
  static bool leaves(const scenes::Sphere& sphere, const Ray& ray) {
    const glm::dvec3 from_center = glm::dvec3(ray.origin) - glm::dvec3(sphere.center);
    const double square = double{sphere.radius} * sphere.radius;
    return glm::dot(from_center, from_center) > square * (1.0 + 0x1p-30) &&
           glm::dot(from_center, glm::dvec3(ray.direction)) > 0.0;
  }

  /// Returns the hits of a block, of which the canonical test decides some: `t_of(ray)` returns t
  /// or kMiss.
  template <class TOf>
  LaneBits decided(std::size_t place, LaneBits hits, LaneBits unsure, scenes::PrimitiveId primitive,
                   TOf t_of) {
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    hits &= ~unsure;
    for (LaneBits left = unsure; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      const Ray& ray = part_->rays[unit_->ray_at(block + lane)];
      const float t = t_of(ray);
      if (!is_hit(t)) continue;
      if constexpr (kClosest) {
        if (!single_rays_->keeps(block + lane, ray, {t, primitive})) continue;
      }
      hits |= LaneBits{1} << lane;
    }
    return hits;
  }

  template <class TOf>
  std::uint32_t test_by_rays(std::size_t place, scenes::PrimitiveId primitive, TOf t_of) {
    return groups_->note(place, decided(place, 0, unit_->alive[place], primitive, t_of));
  }

  LaneBits test_exact_triangle(std::size_t place, const ExactApexTriangle& triangle,
                               scenes::PrimitiveId primitive, Unsure& unsure) {
    const hn::CappedTag<double, 8> d;
    const hn::Rebind<float, decltype(d)> half;
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    // Only the rays are in float: see TriangleShapes.
    const double size =
        std::abs(triangle.plane.x) + std::abs(triangle.plane.y) + std::abs(triangle.plane.z);
    const double slack_at_apex = 0x1p-24 * kSlackOfPlaces<Policy> * size;
    const double slack_per_w = 0x1p-24 * kSlackOfOrigins<Policy> * size * view_->scene_size;
    LaneBits hits = 0;
    alignas(64) std::array<float, PencilUnit::kBlock> found_w;
    for (std::size_t lane = 0; lane < PencilUnit::kBlock; lane += hn::Lanes(d)) {
      const auto u = hn::PromoteTo(d, hn::Load(half, &unit_->u[block + lane]));
      const auto v = hn::PromoteTo(d, hn::Load(half, &unit_->v[block + lane]));
      const auto w = hn::PromoteTo(d, hn::Load(half, &unit_->w[block + lane]));
      const auto line = [&](const glm::dvec3& numbers) {
        return hn::MulAdd(hn::Set(d, numbers.x), u,
                          hn::MulAdd(hn::Set(d, numbers.y), v, hn::Set(d, numbers.z)));
      };
      const auto none = hn::Zero(d);
      const auto plane = line(triangle.plane);
      const auto distance = hn::Set(d, triangle.distance);
      const std::array edges{line(triangle.edges[0]), line(triangle.edges[1]),
                             line(triangle.edges[2])};
      auto hit =
          hn::And(hn::And(hn::Ge(edges[0], none), hn::Ge(edges[1], none)), hn::Ge(edges[2], none));
      const auto within = [&](auto place, double low, double high) {
        return hn::And(hn::Ge(place, hn::Set(d, low)), hn::Le(place, hn::Set(d, high)));
      };
      hit = hn::And(hit, hn::And(within(u, triangle.low.x, triangle.high.x),
                                 within(v, triangle.low.y, triangle.high.y)));
      auto from_origin = hn::Sub(plane, hn::Mul(distance, w));
      auto slack = hn::Set(d, slack_at_apex);
      if constexpr (kClosest) {
        const auto origin_w = hn::PromoteTo(d, hn::Load(half, &unit_->origin_w[block + lane]));
        hit = hn::And(hit, hn::Gt(from_origin, none));  // nearer than the nearest so far
        from_origin = hn::Sub(hn::Mul(distance, origin_w), plane);
        slack = hn::MulAdd(hn::Set(d, slack_per_w), origin_w, slack);
        hn::Store(hn::DemoteTo(half, hn::Div(plane, distance)), half, &found_w[lane]);
      }
      hit = hn::And(hit, hn::Ge(from_origin, hn::Neg(slack)));
      const auto bits = [&](auto mask) {
        std::array<std::uint8_t, 8> stored{};
        hn::StoreMaskBits(d, mask, stored.data());
        return static_cast<LaneBits>(stored[0]) << lane;
      };
      hits |= bits(hit);
      unsure.depth |= bits(hn::And(hit, hn::Lt(from_origin, slack)));
      for (std::size_t k = 0; k < 3; ++k) {
        unsure.edge |= bits(hn::Lt(edges[k], hn::Set(d, triangle.clear[k])));
      }
    }
    hits &= unit_->alive[place];
    unsure.depth &= hits;
    if constexpr (kClosest) {
      hits &= ~unsure.depth;
      for (std::size_t lane = 0; lane < PencilUnit::kBlock; lane += kLanes) {
        const Floats w = load(&unit_->w[block + lane]);
        keep(block + lane, lanes_of(hits >> lane, 0), load(&found_w[lane]), w, primitive);
      }
    }
    return hits;
  }

  /// Computes in units of z: a ray's line is s (u, v, 1). The side of the surface on which a ray
  /// begins determines which of the two roots are within the ray. It is known more accurately than
  /// the roots, but not for rays that begin too close to the surface. As in the canonical test, the
  /// discriminant is computed from the line's point nearest the center (Haines et al., Ray Tracing
  /// Gems, 2019).
  HWY_INLINE LaneBits test_sphere(std::size_t place, std::size_t shape, bool around,
                                  bool inside_only, scenes::PrimitiveId primitive, Unsure& unsure) {
    const OneShape of{*shapes_, shape};
    const Points center{of(SeenShapes::kCenter), of(SeenShapes::kCenter + 1),
                        of(SeenShapes::kCenter + 2)};
    const Floats radius = of(SeenShapes::kRadius);
    const Floats square = hn::Mul(radius, radius);
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    const Floats least_slack = hn::MulAdd(
        radius, all(0x1p-20F), all(0x1p-24F * kSlackOfOrigins<Policy> * view_->scene_size));
    const auto only = [](bool condition) {
      return hn::Gt(all(condition ? 1.0F : 0.0F), hn::Zero(Tag()));
    };
    return for_each_register([&](std::size_t lane) {
      const std::size_t at = block + lane;
      const Points direction{load(&unit_->u[at]), load(&unit_->v[at]), all(1.0F)};
      const Floats per_square = hn::Div(all(1.0F), dot(direction, direction));
      const Floats middle = hn::Mul(dot(direction, center), per_square);
      const auto from_center = [&](Floats s) -> Points {
        return {hn::MulSub(direction.x, s, center.x), hn::MulSub(direction.y, s, center.y),
                hn::Sub(s, center.z)};
      };
      const Points nearest = from_center(middle);
      const Floats left_over = hn::Sub(square, dot(nearest, nearest));
      const Mask meets = hn::Ge(left_over, hn::Zero(Tag()));
      const Floats origin_w = load(kClosest ? &unit_->origin_w[at] : &unit_->w[at]);
      const Floats origin = hn::Div(all(1.0F), origin_w);
      const Points begin = from_center(origin);
      const Floats from_middle = dot(begin, begin);
      const Mask inside = hn::Lt(from_middle, square);
      const Floats slack = hn::MulAdd(origin, all(0x1p-24F * kSlackOfDepths<Policy>), least_slack);
      const Floats may_err = hn::Mul(slack, hn::Add(hn::Add(radius, radius), slack));
      const Mask close = hn::Le(hn::Abs(hn::Sub(from_middle, square)), may_err);
      unsure.depth |= (bits_of(close) << lane) & unit_->alive[place];
      if constexpr (kClosest) {
        const Mask ahead = hn::Or(inside, hn::And(meets, hn::Gt(middle, origin)));
        const Floats half = hn::Sqrt(hn::Mul(hn::Max(left_over, hn::Zero(Tag())), per_square));
        const Mask leaves = hn::Or(inside, only(inside_only));
        const Floats root =
            hn::Max(hn::Add(middle, hn::IfThenElse(leaves, half, hn::Neg(half))), origin);
        const Floats found = hn::Div(all(1.0F), root);
        const Floats w = load(&unit_->w[at]);
        const Mask hit = hn::AndNot(
            close, hn::And(hn::And(ahead, hn::Gt(found, w)), lanes_of(unit_->alive[place], lane)));
        if (!hn::AllFalse(Tag(), hit)) keep(at, hit, found, w, primitive);
        return hit;
      } else {
        // Toward the apex: surfaces passed or left on the way.
        const Mask passes =
            hn::And(meets, hn::And(hn::Lt(middle, origin), hn::Gt(middle, hn::Zero(Tag()))));
        if (around) return inside_only ? only(false) : hn::Not(inside);
        return hn::Or(inside, passes);
      }
    });
  }

  /// Keeps closest hits.
  HWY_INLINE void keep(std::size_t at, Mask hit, Floats found, Floats w,
                       scenes::PrimitiveId primitive) {
    const hn::RebindToUnsigned<Tag> ids;
    store(hn::IfThenElse(hit, found, w), &unit_->w[at]);
    hn::Store(hn::IfThenElse(hn::RebindMask(ids, hit), hn::Set(ids, primitive),
                             hn::Load(ids, &unit_->primitive[at])),
              ids, &unit_->primitive[at]);
  }

  const scenes::Scene* scene_;
  const PencilPart* part_;
  PencilUnit* unit_;
  PencilGroups<Policy>* groups_;
  PencilSingleRays<Policy, Counting>* single_rays_;
  const SeenShapes* shapes_;
  const ApexView* view_;
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

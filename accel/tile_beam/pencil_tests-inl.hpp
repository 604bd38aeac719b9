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
#include "accel/tile_beam/shape_values-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// Tests pairs of a block and a shape, and records the hits. Each function returns the groups that
/// changed.
template <class Policy, class Counting>
class PencilTests {
 public:
  PencilTests(const scenes::Scene& scene, const PencilPart& part, PencilUnit& unit,
              PencilGroups<Policy>& groups, PencilSingleRays<Policy, Counting>& single_rays,
              const SeenShapes& shapes, float scene_size)
      : scene_(&scene),
        part_(&part),
        unit_(&unit),
        groups_(&groups),
        single_rays_(&single_rays),
        shapes_(&shapes),
        scene_size_(scene_size) {}

  HWY_INLINE std::uint32_t test_triangles(std::span<const std::uint32_t> pairs,
                                          const Meshlet& meshlet) {
    const LaneBits special = shapes_->exact | shapes_->by_rays;
    std::uint32_t changed = 0;  // kept in a register: the next test would wait for memory
    for (const std::uint32_t pair : pairs) {
      const std::size_t place = pair / SeenShapes::kMax;
      const std::size_t shape = pair % SeenShapes::kMax;
      if ((special >> shape & 1U) != 0) [[unlikely]] {
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
    LaneBits depth = 0;  ///< rays that begin too close to the shape's plane or surface
    LaneBits edge = 0;   ///< hits close to an edge, which was moved outward
  };

  /// Returns the rays of a block that hit a triangle, and which of these hits are `uncertain`.
  /// These are so few that `told_apart` determines the reason afterward.
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

  /// Divides uncertain hits into those uncertain in depth and, in any-hit queries, those at an
  /// edge.
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

  /// Returns the hits of an any-hit query after single rays through the whole hierarchy have
  /// decided those at an edge: if triangles share the edge, testing only one of them differently
  /// could let the ray pass between them.
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
    // Seen edge-on, a sliver is no wider than the distance by which its edges are moved.
    if (!kClosest) hits = decided_by_rays(place, hits, unsure.edge);
    return groups_->note(place, hits);
  }

  /// Returns the hits of a block after testing in double on which side of a triangle's plane
  /// uncertain rays begin. The edges are not retested: neighbors that share an edge must be tested
  /// in the same way, or a ray could pass between them.
  LaneBits decided_by_plane(std::size_t place, LaneBits hits, LaneBits unsure,
                            const Meshlet& meshlet, std::size_t shape) {
    const TrianglePlane plane(
        {meshlet.corner(0, shape), meshlet.corner(1, shape), meshlet.corner(2, shape)});
    return decided(place, hits, unsure, meshlet.primitives[shape],
                   [&](const Ray& ray) { return plane.hit(ray); });
  }

  /// Returns whether the ray begins outside the sphere, by a clear margin in double, and moves away
  /// from it. This holds for most of the uncertain rays that begin next to a sphere far from the
  /// apex.
  static bool leaves(const scenes::Sphere& sphere, const Ray& ray) {
    const glm::dvec3 from_center = glm::dvec3(ray.origin) - glm::dvec3(sphere.center);
    const double square = double{sphere.radius} * sphere.radius;
    return glm::dot(from_center, from_center) > square * (1.0 + 0x1p-30) &&
           glm::dot(from_center, glm::dvec3(ray.direction)) > 0.0;
  }

  /// Returns the hits of a block after the canonical test has decided some of them: `t_of(ray)`
  /// returns t or kMiss.
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
    // Only the rays are in float; see TriangleShapes.
    const double size =
        std::abs(triangle.plane.x) + std::abs(triangle.plane.y) + std::abs(triangle.plane.z);
    const double slack_at_apex = 0x1p-24 * kSlackOfPlaces<Policy> * size;
    const double slack_per_w = 0x1p-24 * kSlackOfOrigins<Policy> * size * scene_size_;
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

  /// Returns the rays of a block that hit a sphere; `unsure` receives those that float cannot
  /// decide. In the side's coordinates, a ray's line is s (u, v, 1). The side of the surface on
  /// which a ray begins determines which of the two roots are within the ray. Except for rays that
  /// begin too close to the surface, this side is known more accurately than the roots. As in the
  /// canonical test, the discriminant is computed from the point of the line nearest to the center
  /// (Haines et al., Ray Tracing Gems, 2019).
  HWY_INLINE LaneBits test_sphere(std::size_t place, std::size_t shape, bool around,
                                  bool inside_only, scenes::PrimitiveId primitive, Unsure& unsure) {
    const OneShape of{*shapes_, shape};
    const Points center{of(SeenShapes::kCenter), of(SeenShapes::kCenter + 1),
                        of(SeenShapes::kCenter + 2)};
    const Floats radius = of(SeenShapes::kRadius);
    const Floats square = hn::Mul(radius, radius);
    const std::size_t block = unit_->slot[place] * PencilUnit::kBlock;
    const Floats least_slack =
        hn::MulAdd(radius, all(0x1p-20F), all(0x1p-24F * kSlackOfOrigins<Policy> * scene_size_));
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
        // Toward the apex, a ray hits a sphere that it crosses or leaves on its way.
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
  float scene_size_;  ///< the largest |coordinate|
};

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

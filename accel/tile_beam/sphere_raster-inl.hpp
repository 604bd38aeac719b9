// Draws spheres into a tile: a box on the screen, then the equation for its samples.

#if defined(ACCEL_TILE_BEAM_SPHERE_RASTER_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ACCEL_TILE_BEAM_SPHERE_RASTER_INL
#undef ACCEL_TILE_BEAM_SPHERE_RASTER_INL
#else
#define ACCEL_TILE_BEAM_SPHERE_RASTER_INL
#endif

#include <cmath>

#include "accel/core/intersect_sphere.hpp"
#include "accel/tile_beam/ray_raster-inl.hpp"
#include "accel/tile_beam/tile_hierarchy.hpp"

HWY_BEFORE_NAMESPACE();
namespace beambench::accel::tile_beam::HWY_NAMESPACE {

/// The range of a sphere along one axis of the screen: the tangents from the eye to a circle, given
/// the `beside` and `depth` of its center at equal scale. Valid for depth > radius.
struct Extent {
  Floats low;
  Floats high;
};

HWY_INLINE Extent tangents(Floats beside, Floats depth, Floats radius) {
  const Floats square = hn::Mul(radius, radius);
  const Floats per = hn::Div(all(1.0F), hn::NegMulAdd(radius, radius, hn::Mul(depth, depth)));
  const Floats length =
      hn::Sqrt(hn::Sub(hn::MulAdd(beside, beside, hn::Mul(depth, depth)), square));
  const Floats middle = hn::Mul(beside, depth);
  const Floats around = hn::Mul(radius, length);
  return {hn::Mul(hn::Sub(middle, around), per), hn::Mul(hn::Add(middle, around), per)};
}

/// The samples that the spheres of a block may cover, and their smallest distances.
struct SphereBoxes {
  alignas(64) std::array<std::array<float, kTileLanes>, 4> box;  ///< left, right, top, bottom
  alignas(64) std::array<float, kTileLanes> nearest;             ///< the largest 1/t
  LaneBits seen;

  HWY_INLINE SampleRectangle rectangle(std::size_t lane) const {
    const auto side = [&](std::size_t which) {
      return static_cast<std::uint8_t>(static_cast<int>(box[which][lane]));
    };
    return {side(0), side(1), side(2), side(3)};
  }
};

HWY_INLINE void see_spheres(const SphereBlock& block, const TileView& view, SphereBoxes& boxes) {
  const Points eye = all_of(view.eye);
  const Points to_depth = all_of(view.depth);
  // The view's axes at equal scale; right and down are perpendicular to depth.
  const auto scale_x = static_cast<float>(view.per_angle_x);
  const auto scale_y = static_cast<float>(view.per_angle_y);
  const Points to_right = all_of(view.right * scale_x);
  const Points to_down = all_of(view.down * scale_y);
  const float left = glm::dot(view.origin, view.right) * scale_x * scale_x;
  const float top = glm::dot(view.origin, view.down) * scale_y * scale_y;
  const Floats width = all(static_cast<float>(view.width - 1));
  const Floats height = all(static_cast<float>(view.height - 1));
  const Floats none = hn::Zero(Tag());

  boxes.seen = for_each_register([&](std::size_t lane) {
    const Points center{hn::Sub(load(&block.center[0][lane]), eye.x),
                        hn::Sub(load(&block.center[1][lane]), eye.y),
                        hn::Sub(load(&block.center[2][lane]), eye.z)};
    const Floats radius =
        hn::MulAdd(load(&block.radius[lane]), all(1.0F + 0x1p-20F), all(2.0F * view.slack_depth));
    const Floats depth = dot(center, to_depth);
    const Extent x = tangents(dot(center, to_right), depth, radius);
    const Extent y = tangents(dot(center, to_down), depth, radius);
    const Floats near = hn::Sub(depth, radius);
    const Mask before = hn::Gt(near, hn::Mul(radius, all(0x1p-10F)));
    const auto place = [](Floats tangent, float scale, float origin, float slack) {
      return hn::MulAdd(tangent, all(scale), all(slack - origin));
    };
    constexpr float kSlack = 0x1p-4F;
    const Floats low_x = hn::Max(place(x.low, scale_x, left, -kSlack), none);
    const Floats high_x = hn::Min(place(x.high, scale_x, left, kSlack), width);
    const Floats low_y = hn::Max(place(y.low, scale_y, top, -kSlack), none);
    const Floats high_y = hn::Min(place(y.high, scale_y, top, kSlack), height);
    // A sphere that contains, or nearly contains, the eye may be anywhere.
    const Floats box_left = hn::Ceil(hn::IfThenElse(before, low_x, none));
    const Floats box_right = hn::Floor(hn::IfThenElse(before, high_x, width));
    const Floats box_top = hn::Ceil(hn::IfThenElse(before, low_y, none));
    const Floats box_bottom = hn::Floor(hn::IfThenElse(before, high_y, height));
    store(box_left, &boxes.box[0][lane]);
    store(box_right, &boxes.box[1][lane]);
    store(box_top, &boxes.box[2][lane]);
    store(box_bottom, &boxes.box[3][lane]);
    store(hn::IfThenElse(before, hn::Div(all(1.0F), near), all(kNearestOfAll)),
          &boxes.nearest[lane]);
    const Mask in_front = hn::Ge(hn::Add(depth, radius), none);
    return hn::And(in_front, hn::And(hn::Le(box_left, box_right), hn::Le(box_top, box_bottom)));
  });
  boxes.seen &= (LaneBits{1} << block.count) - 1;
}

/// Draws one sphere, whose largest 1/t is `nearest`, into the blocks of a box. As in the canonical
/// test, t is computed from the point of the ray nearest to the center (Haines et al., Ray Tracing
/// Gems, 2019). The hit then lies within a few roundings of its distance from the surface, however
/// small or distant the sphere is.
HWY_INLINE void draw_sphere(const glm::vec3& from_eye, float radius, bool inside_only,
                            scenes::PrimitiveId primitive, const SampleRectangle& box,
                            float nearest, const TileView& view, TileImage& image) {
  const Points center = all_of(from_eye);
  const Points right = all_of(view.right);
  const Points down = all_of(view.down);
  const Floats square = all(radius * radius);
  const Mask take_far = hn::Gt(all(inside_only ? 1.0F : 0.0F), hn::Zero(Tag()));
  for (int row = box.top >> 2; row <= box.bottom >> 2; ++row) {
    for (std::size_t first = 0; first < TileImage::kBlockSamples; first += kLanes) {
      const Floats j = hn::Add(block_y(first), all(static_cast<float>(4 * row)));
      const Points row_start{hn::MulAdd(down.x, j, all(view.origin.x)),
                             hn::MulAdd(down.y, j, all(view.origin.y)),
                             hn::MulAdd(down.z, j, all(view.origin.z))};
      for (int column = box.left >> 2; column <= box.right >> 2; ++column) {
        const std::size_t at = TileImage::block(column, row) + first;
        if (hn::AllTrue(Tag(), hn::Gt(load(&image.inverse_t[at]), all(nearest)))) continue;
        const Floats i = hn::Add(block_x(first), all(static_cast<float>(4 * column)));
        const Points direction{hn::MulAdd(right.x, i, row_start.x),
                               hn::MulAdd(right.y, i, row_start.y),
                               hn::MulAdd(right.z, i, row_start.z)};
        const Floats per_square = hn::Div(all(1.0F), dot(direction, direction));
        const Floats middle_t = hn::Mul(dot(direction, center), per_square);
        const Points beside{hn::NegMulAdd(middle_t, direction.x, center.x),
                            hn::NegMulAdd(middle_t, direction.y, center.y),
                            hn::NegMulAdd(middle_t, direction.z, center.z)};
        const Floats left_over = hn::Sub(square, dot(beside, beside));
        const Floats half_chord =
            hn::Sqrt(hn::Mul(hn::Max(left_over, hn::Zero(Tag())), per_square));
        const Floats near_t = hn::Sub(middle_t, half_chord);
        const Mask leaves = hn::Or(take_far, hn::Lt(near_t, hn::Zero(Tag())));
        const Floats t = hn::IfThenElse(leaves, hn::Add(middle_t, half_chord), near_t);
        const Mask hit = hn::And(hn::Ge(left_over, hn::Zero(Tag())), hn::Ge(t, hn::Zero(Tag())));
        keep_nearer(image, at, hn::Div(all(1.0F), hn::Abs(t)), hit, primitive);  // t may be -0
      }
    }
  }
}

/// Returns whether the eye is so close to a sphere's surface that float cannot decide its side.
/// Without this check, half of the hits at t = 0 would be lost.
HWY_INLINE bool is_at_eye(const glm::vec3& from_eye, float radius) {
  const float distance_squared = glm::dot(from_eye, from_eye);
  const float radius_squared = radius * radius;
  return std::abs(distance_squared - radius_squared) <=
         0x1p-19F * (distance_squared + radius_squared);
}

/// Draws the spheres of a block, the nearest first. Parts behind `farthest` (1/t) are not drawn.
inline void draw_spheres(const SphereBlock& block, const scenes::Scene& scene, const TileRays& rays,
                         float farthest, TileImage& image) {
  const TileView& view = rays.view;
  SphereBoxes boxes;
  see_spheres(block, view, boxes);
  for (LaneBits left = boxes.seen; left != 0;) {
    const std::size_t lane = largest_of(boxes.nearest, left);
    left &= ~(LaneBits{1} << lane);
    const float nearest = boxes.nearest[lane] * (1.0F + 0x1p-18F);
    if (nearest < farthest) return;
    const SampleRectangle box = boxes.rectangle(lane);
    if (hides(image, box, nearest)) continue;
    const scenes::PrimitiveId primitive = block.primitives[lane];
    const glm::vec3 center(block.center[0][lane], block.center[1][lane], block.center[2][lane]);
    if (is_at_eye(center - view.eye, block.radius[lane])) {
      const scenes::Sphere& sphere = scene.spheres[scene.primitives[primitive].index];
      draw_by_rays(rays, box, nearest, primitive, image,
                   [&](const CanonicalRay& ray) { return intersect_sphere(ray, sphere); });
    } else {
      draw_sphere(center - view.eye, block.radius[lane], (block.inside_only >> lane & 1U) != 0,
                  primitive, box, nearest, view, image);
    }
    mark_stale(image, box);
  }
}

}  // namespace beambench::accel::tile_beam::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

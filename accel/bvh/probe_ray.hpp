#pragma once
// A ray in single precision, for tests that can reject but not confirm hits.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "accel/core/canonical_ray.hpp"
#include "accel/core/ray.hpp"
#include "scenes/bounds.hpp"

namespace beambench::accel::bvh {

/// A ray and the error bounds of the float tests made with it. The canonical tests reject
/// everything that these reject, but not vice versa.
///
/// Let e = 2^-24 (a rounding's relative error) and R = `reach`, at least the distance along any
/// axis from the origin to any point of the scene.
///
/// **Boxes.** (plane - origin) * inverse has a relative error below 3 e and the right sign: t
/// intervals are compared after one end is enlarged by kWider. The inverse of a direction component
/// of 0 is the largest float. The product is never NaN; it is 0 only in the plane of a widened
/// box's face, where nothing can be hit.
///
/// **Triangles.** Corners are moved by the origin and sheared so that the ray becomes an axis (as
/// CanonicalRay::beside does). A sheared coordinate is off by at most 7 e R. Let s be at least the
/// longest side of the box of any triangle of the leaf. If a ray hits one of these triangles, its
/// corners are within s of the hit along each axis: sheared, they are at most P = 2 s + 20 e R. The
/// areas a.x b.y - a.y b.x are then wrong by at most 4 P 7eR + 2 (7eR)^2 + 4 e P^2, which 40 e R (P
/// + 12 e R) exceeds (P <= 2 R). Depths along the main axis are off by 3 e R, and the canonical hit
/// is within 2^-10 e R x 20 of its triangle: 5 e R / |direction| covers both.
///
/// **Triangles behind the origin.** Let o be the origin, a a corner, e1 and e2 the edges from it,
/// and |x| the sum of the sizes of x's components. The canonical test has t = V / N, with the
/// volume V = (a - o).(e1 x e2) and N = direction.(e1 x e2). With d, the direction along the main
/// axis, and D, the sum of the sheared areas, N = -d D: the shear preserves volumes, and the axes
/// are in cyclic order. So t < 0 where V D / d > 0, if both signs are certain:
/// - V in float is off by at most 8 e |a - o| |e1| |e2|: three differences, each with a relative
///   error of e, and five more roundings. 16 e is allowed, and 2^-120 for products that underflow.
/// - D is off by 3 m and the rounding of its sums, m being the bound of the areas' error. Beyond
///   4 m its sign is right, and it is nearly m or more.
///
/// The canonical test then has the same signs: in double V is off by 2^-50 |a - o| |e1| |e2|, and N
/// by 2^-50 |direction| |e1| |e2| <= 2^-44 |d| R s, while |d| m > 2^-18 |d| R s. The hit's computed
/// point does not matter, because that test only rejects more. One case remains: a negative t that
/// underflows is -0, which t_min = 0 accepts. Another 2^-33 R |e1| |e2| is therefore allowed: t is
/// then beyond -2^-33 R / |direction|.
///
/// **Spheres.** The vector from the center to the nearest point of the line is off by at most
/// 21 e R: 32 e R is added to the radius, and as much to the depth of the sphere.
class ProbeRay {
 public:
  /// Returns whether factors and margins have ordinary sizes: the square of the largest direction
  /// component must neither vanish nor overflow.
  static bool can_probe(const Ray& ray) {
    const glm::vec3 size = glm::abs(ray.direction);
    const float largest = std::max({size.x, size.y, size.z});
    return largest > 0x1p-60F && largest < 0x1p60F;
  }

  ProbeRay(const Ray& ray, const scenes::Bounds& scene_bounds) : t_min(ray.t_min) {
    // Avoids branches, which would be unpredictable for the directions of secondary rays.
    float reach = 0.0F;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      origin[axis] = glm::value_ptr(ray.origin)[axis];
      direction[axis] = glm::value_ptr(ray.direction)[axis];
      constexpr float kLargest = std::numeric_limits<float>::max();
      const float quotient = 1.0F / direction[axis];
      inverse[axis] = std::clamp(quotient, -kLargest, kLargest);
      far_inverse[axis] = std::clamp(quotient * kWider, -kLargest, kLargest);
      const auto backward = std::size_t{std::bit_cast<std::uint32_t>(direction[axis]) >> 31U};
      near_row[axis] = axis + 3 * backward;
      far_row[axis] = axis + 3 - 3 * backward;
      octant |= backward << axis;
      const float below = std::abs(glm::value_ptr(scene_bounds.lower)[axis] - origin[axis]);
      const float above = std::abs(glm::value_ptr(scene_bounds.upper)[axis] - origin[axis]);
      reach = std::max(reach, std::max(below, above));
    }
    set_shear(*this, ray.direction);
    rounding = 0x1p-24F * reach;
    depth_margin = 5.0F * rounding * std::abs(inverse[main_axis]);
  }

  /// Returns the error bound of the areas of triangles in a leaf, given the longest side of their
  /// boxes.
  float area_margin(float leaf_extent) const {
    return 40.0F * rounding * (2.0F * leaf_extent + 32.0F * rounding);
  }

  /// Enlarges the far end of a t interval in box tests.
  static constexpr float kWider = 1.0F + 0x1p-20F;

  // Arrays, because selecting an axis of a glm vector at run time is a chain of branches.
  std::array<float, 3> origin;
  std::array<float, 3> direction;
  float t_min;
  std::array<float, 3> inverse;
  std::array<float, 3> far_inverse;     ///< enlarged by kWider, but finite
  std::array<std::size_t, 3> near_row;  ///< row of WideNode::planes for each axis
  std::array<std::size_t, 3> far_row;
  std::size_t octant = 0;  ///< index into WideNode::orders
  std::size_t main_axis;
  std::array<std::size_t, 2> side_axis;
  std::array<float, 2> shear;
  float rounding;      ///< e R
  float depth_margin;  ///< error bound of a triangle's t
};

}  // namespace beambench::accel::bvh

#pragma once
// A list of rays for one call.

#include <cstddef>
#include <span>

#include <glm/vec3.hpp>

#include "accel/core/ray.hpp"

namespace beambench::accel {

/// The rays [first, first + count) of a batch, which pass through one common point but for the
/// rounding of their numbers: a point light, or the virtual eye of a planar mirror.
struct Pencil {
  std::size_t first;
  std::size_t count;
  glm::dvec3 apex;
  bool toward;  ///< the rays run toward the apex, as shadow rays do; otherwise away from it
};

/// Rays, and the pencils among them: in the order of `first`, and no ray is in two. Pencils are a
/// hint that changes no hit, and the rays are the same bits with and without them. Reserved:
/// nothing marks pencils yet, and every structure ignores them.
struct RayBatch {
  std::span<const Ray> rays;
  std::span<const Pencil> pencils{};
};

}  // namespace beambench::accel

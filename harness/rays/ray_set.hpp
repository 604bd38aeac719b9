#pragma once
// A list of rays that is made once and asked of everyone.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "accel/core/ray.hpp"
#include "harness/rays/ray_kind.hpp"

namespace beambench::rays {

/// Rays, what is asked about them, and where they come from.
struct RaySet {
  std::string label;  ///< as records and commands name it (`RayChoice::label`)
  Query query = Query::kClosestHit;
  std::uint64_t seed = 0;                   ///< 0 where nothing is random
  std::optional<std::uint64_t> scene_hash;  ///< of the scene they were made for, where known
  std::vector<accel::Ray> rays;
};

/// How alike neighbors in a list are: the mean cosine of the angle between the directions of a ray
/// and the next. 1: all parallel; 0: nothing in common. 1 for fewer than two rays.
double coherence(std::span<const accel::Ray> rays);

}  // namespace beambench::rays

#pragma once
// A list of rays that is generated once and traced by every structure.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "accel/core/primary_rays.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/ray_batch.hpp"
#include "harness/rays/ray_kind.hpp"

namespace beambench::rays {

/// A batch, and the objects that it refers to.
struct RayList {
  std::vector<accel::Ray> rays{};
  std::vector<std::uint32_t>
      samples{};  ///< of each ray; empty if the rays do not come from an image
  std::shared_ptr<const accel::PrimaryRays> image{};  ///< the image that the rays come from
  std::vector<accel::Pencil> pencils{};
  std::vector<std::shared_ptr<const accel::PrimaryRays>> views{};  ///< the views of pencils
  accel::BatchMarks marks{};

  accel::RayBatch batch() const {
    const bool is_marked = !marks.bundles.empty() || !marks.refracted.empty();
    return {rays, pencils, samples, image.get(), is_marked ? &marks : nullptr};
  }
};

/// Rays, the query for them, and how they were made.
struct RaySet : RayList {
  std::string label{};  ///< the name in records and commands (`RayChoice::label`)
  Query query = Query::kClosestHit;
  std::uint64_t seed = 0;  ///< 0 if nothing is random
  std::optional<std::uint64_t>
      scene_hash{};        ///< of the scene that the rays were made for, if known
  bool may_graze = false;  ///< aimed at edges and corners: any number of grazes is allowed
  bool must_hit = false;   ///< from inside a closed surface: a ray that misses it has leaked
};

/// The coherence of a list: the mean cosine of the angle between the directions of a ray and the
/// next. It is 1 for parallel rays and about 0 for unrelated ones; for fewer than two rays it is 1.
double coherence(std::span<const accel::Ray> rays);

}  // namespace beambench::rays

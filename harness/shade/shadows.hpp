#pragma once
// How much of a light comes to a point.

#include <cstddef>
#include <vector>

#include "accel/accelerator.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/shade/light_buffer.hpp"
#include "harness/shade/ray_census.hpp"
#include "harness/shade/whitted_options.hpp"
#include "scenes/scene.hpp"

namespace beambench {

/// The opaque primitive that hid each light last, for each depth of rays (as the ray tracer OORT
/// has it; Wilt, Object-Oriented Ray Tracing in C++, 1994): neighbouring points are mostly hidden
/// by the same one.
struct ShadowCache {
  ShadowCache(std::size_t lights, int depths)
      : last(lights * static_cast<std::size_t>(depths), kNoPrimitive) {}

  std::vector<PrimitiveId> last;  ///< by depth, then by light
};

/// Shadow rays over a structure. Queries are const and safe from several threads, each with a cache
/// of its own.
class Shadows {
 public:
  /// Makes light buffers where the options ask for them. Scene and structure must outlive this.
  Shadows(const Scene& scene, const Accelerator& structure, const WhittedOptions& options,
          HitCheck check);

  /// The part of a light that comes through: 0 behind an opaque primitive, the product of the
  /// transmittances of transparent surfaces before it, 1 where nothing is. `to_light` begins at a
  /// point, `depth` rays from the eye (the eye's ray is 1), and has the light at t = 1. Throws
  /// InvalidHit.
  double transmitted(const Ray& to_light, std::size_t light, int depth, ShadowCache& cache,
                     RayCensus& census) const;

  /// Of light buffers; 0 without.
  std::size_t memory_bytes() const;

 private:
  double asked_by_cache(const Ray& to_light, PrimitiveId& last, RayCensus& census) const;
  double asked_by_buffer(const Ray& to_light, std::size_t light, RayCensus& census) const;
  double followed(const Ray& to_light, PrimitiveId& blocker, RayCensus& census) const;

  const Scene* scene_;
  const Accelerator* structure_;
  HitCheck check_;
  ShadowMethod method_;
  bool all_opaque_;
  std::vector<LightBuffer> buffers_;  ///< one a light, or none
};

}  // namespace beambench

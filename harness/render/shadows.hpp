#pragma once
// How much of a light comes to a point.

#include <cstddef>
#include <vector>

#include "accel/core/accelerator.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/render/light_buffer.hpp"
#include "harness/render/ray_census.hpp"
#include "harness/render/whitted_options.hpp"
#include "scenes/scene.hpp"

namespace beambench::render {

/// The opaque primitive that hid each light last, for each depth of rays (as the ray tracer OORT
/// has it; Wilt, Object-Oriented Ray Tracing in C++, 1994): neighboring points are mostly hidden
/// by the same one.
struct ShadowCache {
  ShadowCache(std::size_t lights, int depths)
      : last(lights * static_cast<std::size_t>(depths), scenes::kNoPrimitive) {}

  std::vector<scenes::PrimitiveId> last;  ///< by depth, then by light
};

/// Shadow rays over a structure. Queries are const and safe from several threads, each with a cache
/// of its own.
class Shadows {
 public:
  /// Makes light buffers where the options ask for them. Scene and structure must outlive this.
  Shadows(const scenes::Scene& scene, const accel::Accelerator& structure,
          const WhittedOptions& options, rays::HitCheck check);

  /// The part of a light that comes through: 0 behind an opaque primitive, the product of the
  /// transmittances of transparent surfaces before it, 1 where nothing is. `to_light` begins at a
  /// point, `depth` rays from the eye (the eye's ray is 1), and has the light at t = 1. Throws
  /// InvalidHit.
  double transmitted(const accel::Ray& to_light, std::size_t light, int depth, ShadowCache& cache,
                     RayCensus& census) const;

  /// Of light buffers; 0 without.
  std::size_t memory_bytes() const;

 private:
  double asked_by_cache(const accel::Ray& to_light, scenes::PrimitiveId& last,
                        RayCensus& census) const;
  double asked_by_buffer(const accel::Ray& to_light, std::size_t light, RayCensus& census) const;
  double followed(const accel::Ray& to_light, scenes::PrimitiveId& blocker,
                  RayCensus& census) const;

  const scenes::Scene* scene_;
  const accel::Accelerator* structure_;
  rays::HitCheck check_;
  ShadowMethod method_;
  bool all_opaque_;
  std::vector<LightBuffer> buffers_;  ///< one a light, or none
};

}  // namespace beambench::render

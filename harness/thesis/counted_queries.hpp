#pragma once
// What stands between the shadow rays of a picture and their structure, to count their work.

#include "harness/rays/counted_queries.hpp"

namespace beambench::thesis {

using rays::CountedQueries;
using rays::QueryWork;

/// Of shadow rays, the work up to the first thing that hides the light, as any-hit queries: what
/// published counts are of. Where that is glass, or may be, closest hits are asked for and the ray
/// goes on behind it: this is not counted.
class CountedShadows : public CountedQueries {
 public:
  using CountedQueries::CountedQueries;

  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override {
    // A shadow ray begins at 0, and behind glass beyond it.
    rays.for_each([&](std::size_t, const accel::Ray& ray) {
      if (ray.t_min <= 0.0F) any_hit(ray);
    });
    structure().closest_hits(rays, hits, {nullptr, context.threads});
  }
};

}  // namespace beambench::thesis

#pragma once
// Counts the work of a picture's shadow rays, between them and their structure.

#include "harness/rays/counted_queries.hpp"

namespace beambench::thesis {

using rays::CountedQueries;
using rays::QueryWork;

/// Counts the work of shadow rays up to the first object that hides the light, as any-hit queries,
/// like published counts. If that is glass, or may be, closest hits are used and the ray continues
/// behind it, which is not counted.
class CountedShadows : public CountedQueries {
 public:
  using CountedQueries::CountedQueries;

  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override {
    // A shadow ray begins at 0, but beyond it behind glass.
    rays.for_each([&](std::size_t, const accel::Ray& ray) {
      if (ray.t_min <= 0.0F) any_hit(ray);
    });
    structure().closest_hits(rays, hits, {nullptr, context.threads});
  }
};

}  // namespace beambench::thesis

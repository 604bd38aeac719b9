#pragma once
// Counts the work of a picture's shadow rays, between the tracer and the structure.

#include "harness/rays/counted_queries.hpp"

namespace beambench::thesis {

using rays::CountedQueries;
using rays::QueryWork;

/// Counts the work of shadow rays up to the first object that hides the light, traced as any-hit
/// queries, as in published counts. If that object may be glass, uses closest hits and continues
/// the ray behind it without counting.
class CountedShadows : public CountedQueries {
 public:
  using CountedQueries::CountedQueries;

  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override {
    // A shadow ray begins at t = 0; its continuation behind glass begins at a larger t.
    rays.for_each([&](std::size_t, const accel::Ray& ray) {
      if (ray.t_min <= 0.0F) any_hit(ray);
    });
    structure().closest_hits(rays, hits, {nullptr, context.threads});
  }
};

}  // namespace beambench::thesis

#pragma once
// Queries whose work is counted.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>

#include "accel/core/forwarding_accelerator.hpp"
#include "scenes/primitive.hpp"

namespace beambench::rays {

/// The work of all queries together.
struct QueryWork {
  std::uint64_t rays = 0;
  std::uint64_t rays_that_hit = 0;
  accel::WorkCounters counters;

  void add(const QueryWork& other) {
    rays += other.rays;
    rays_that_hit += other.rays_that_hit;
    counters.add(other.counters);
  }
};

/// The hits of another structure, and the work of all queries together. The counters that a query
/// is called with are not added to. Several threads may query at once.
class CountedQueries : public accel::ForwardingAccelerator {
 public:
  using ForwardingAccelerator::ForwardingAccelerator;

  /// Returns the work of all queries that have returned.
  QueryWork work() const {
    const std::lock_guard lock(adding_);
    return work_;
  }

  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override {
    QueryWork own{.rays = rays.size(), .rays_that_hit = 0, .counters = {}};
    structure().closest_hits(rays, hits, {&own.counters, context.threads});
    const std::span primitives(hits.primitive(), rays.size());
    own.rays_that_hit = rays.size() - static_cast<std::uint64_t>(
                                          std::ranges::count(primitives, scenes::kNoPrimitive));
    add(own);
  }
  void any_hits(const accel::RaySource& rays, std::span<std::uint8_t> hits,
                const accel::QueryContext& context) const override {
    QueryWork own{.rays = rays.size(), .rays_that_hit = 0, .counters = {}};
    structure().any_hits(rays, hits, {&own.counters, context.threads});
    own.rays_that_hit = static_cast<std::uint64_t>(std::ranges::count(hits, 1));
    add(own);
  }

 private:
  void add(const QueryWork& own) const {
    const std::lock_guard lock(adding_);
    work_.add(own);
  }

  mutable std::mutex adding_;
  mutable QueryWork work_;
};

}  // namespace beambench::rays

#pragma once
// Queries with counted work.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>

#include "accel/core/forwarding_accelerator.hpp"
#include "scenes/primitive.hpp"

namespace beambench::rays {

/// The total work of all queries.
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

/// Forwards queries to another structure and counts their total work. The caller's counters are not
/// increased. Thread-safe.
class CountedQueries : public accel::ForwardingAccelerator {
 public:
  using ForwardingAccelerator::ForwardingAccelerator;

  /// Returns the work of all finished queries.
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

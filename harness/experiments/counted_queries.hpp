#pragma once
// What stands between a picture and its structure: queries whose work is counted.

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "accel/core/accelerator.hpp"
#include "scenes/primitive.hpp"

namespace beambench::experiments {

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
class CountedQueries : public accel::Accelerator {
 public:
  /// The structure must outlive this.
  explicit CountedQueries(const accel::Accelerator& structure) : structure_(&structure) {}

  /// Of all queries that have returned.
  QueryWork work() const {
    const std::lock_guard lock(adding_);
    return work_;
  }

  std::optional<accel::Hit> closest_hit(const accel::Ray& ray,
                                        accel::WorkCounters*) const override {
    QueryWork own{.rays = 1, .rays_that_hit = 0, .counters = {}};
    auto hit = structure_->closest_hit(ray, &own.counters);
    own.rays_that_hit = hit ? 1 : 0;
    add(own);
    return hit;
  }
  bool any_hit(const accel::Ray& ray, accel::WorkCounters*) const override {
    QueryWork own{.rays = 1, .rays_that_hit = 0, .counters = {}};
    const bool hit = structure_->any_hit(ray, &own.counters);
    own.rays_that_hit = hit ? 1 : 0;
    add(own);
    return hit;
  }
  void trace(const accel::PrimaryRays& rays, accel::HitBuffer& buffer,
             accel::WorkCounters*) const override {
    QueryWork own{.rays = buffer.size(), .rays_that_hit = 0, .counters = {}};
    structure_->trace(rays, buffer, &own.counters);
    own.rays_that_hit = hits_of(buffer);
    add(own);
  }
  void closest_hits(const accel::RayBatch& batch, accel::HitBuffer& buffer,
                    accel::WorkCounters*) const override {
    QueryWork own{.rays = buffer.size(), .rays_that_hit = 0, .counters = {}};
    structure_->closest_hits(batch, buffer, &own.counters);
    own.rays_that_hit = hits_of(buffer);
    add(own);
  }
  void any_hits(const accel::RayBatch& batch, std::span<std::uint8_t> hits,
                accel::WorkCounters*) const override {
    QueryWork own{.rays = hits.size(), .rays_that_hit = 0, .counters = {}};
    structure_->any_hits(batch, hits, &own.counters);
    own.rays_that_hit = static_cast<std::uint64_t>(std::ranges::count(hits, 1));
    add(own);
  }
  std::vector<accel::BeamPlace> beam_places(const accel::PrimaryRays& rays) const override {
    return structure_->beam_places(rays);
  }
  std::vector<accel::BeamPlace> beam_places(const accel::RayBatch& batch) const override {
    return structure_->beam_places(batch);
  }
  accel::Statistics statistics() const override { return structure_->statistics(); }

 protected:
  const accel::Accelerator& structure() const { return *structure_; }

 private:
  static std::uint64_t hits_of(const accel::HitBuffer& buffer) {
    const std::span primitives(buffer.primitive(), buffer.size());
    return buffer.size() -
           static_cast<std::uint64_t>(std::ranges::count(primitives, scenes::kNoPrimitive));
  }
  void add(const QueryWork& own) const {
    const std::lock_guard lock(adding_);
    work_.add(own);
  }

  const accel::Accelerator* structure_;
  mutable std::mutex adding_;
  mutable QueryWork work_;
};

/// Of shadow rays, the work up to the first thing that hides the light, as any-hit queries: what
/// published counts are of. Where that is glass, or may be, closest hits are asked for and the ray
/// goes on behind it: this is not counted.
class CountedShadows : public CountedQueries {
 public:
  using CountedQueries::CountedQueries;

  std::optional<accel::Hit> closest_hit(const accel::Ray& ray,
                                        accel::WorkCounters*) const override {
    count_first(ray);
    return structure().closest_hit(ray, nullptr);
  }
  void closest_hits(const accel::RayBatch& batch, accel::HitBuffer& buffer,
                    accel::WorkCounters*) const override {
    for (const accel::Ray& ray : batch.rays) count_first(ray);
    structure().closest_hits(batch, buffer, nullptr);
  }

 private:
  /// A shadow ray begins at 0, and behind glass beyond it.
  void count_first(const accel::Ray& ray) const {
    if (ray.t_min <= 0.0F) any_hit(ray, nullptr);
  }
};

}  // namespace beambench::experiments

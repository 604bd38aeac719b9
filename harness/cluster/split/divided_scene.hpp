#pragma once
// A divided scene as a structure that answers rays.

#include "accel/core/accelerator.hpp"
#include "harness/cluster/split/light_exchange.hpp"
#include "harness/cluster/split/part_tracer.hpp"

namespace beambench::cluster {

/// On process 0: what all processes find together. The threads that ask trace the rays as far as
/// they go in this part; what reaches the border is left at the exchange. So a batch is as many
/// rays in one round, and a ray alone is a round too.
class DividedScene : public accel::Accelerator {
 public:
  /// Both must outlive it. `statistics` are those of this part.
  DividedScene(const PartTracer& part, LightExchange& exchange, accel::Statistics statistics);

  std::optional<accel::Hit> closest_hit(const accel::Ray& ray,
                                        accel::WorkCounters* counters) const override;
  bool any_hit(const accel::Ray& ray, accel::WorkCounters* counters) const override;
  void trace(const accel::PrimaryRays& rays, accel::HitBuffer& buffer,
             accel::WorkCounters* counters) const override;
  void closest_hits(const accel::RayBatch& batch, accel::HitBuffer& buffer,
                    accel::WorkCounters* counters) const override;
  void any_hits(const accel::RayBatch& batch, std::span<std::uint8_t> hits,
                accel::WorkCounters* counters) const override;
  accel::Statistics statistics() const override { return statistics_; }

 private:
  std::vector<accel::Hit> hits_of(std::span<const accel::Ray> rays, LightQuery query) const;

  const PartTracer* part_;
  LightExchange* exchange_;
  accel::Statistics statistics_;
};

}  // namespace beambench::cluster

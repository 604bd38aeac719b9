#pragma once
// A divided scene as a structure that answers rays.

#include "accel/core/accelerator.hpp"
#include "harness/thesis/cluster/split/light_exchange.hpp"
#include "harness/thesis/cluster/split/part_tracer.hpp"

namespace beambench::cluster {

/// On process 0: what all processes find together. The threads that ask trace the rays as far as
/// they go in this part; what reaches the border is left at the exchange. So a batch is as many
/// rays in one round, and a ray alone is a round too.
class DividedScene : public accel::Accelerator {
 public:
  /// Both must outlive it. `statistics` are those of this part.
  DividedScene(const PartTracer& part, LightExchange& exchange, accel::Statistics statistics);

  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override;
  void any_hits(const accel::RaySource& rays, std::span<std::uint8_t> hits,
                const accel::QueryContext& context) const override;
  accel::Statistics statistics() const override { return statistics_; }

 private:
  std::vector<accel::Hit> hits_of(const accel::RaySource& rays, LightQuery query) const;

  const PartTracer* part_;
  LightExchange* exchange_;
  accel::Statistics statistics_;
};

}  // namespace beambench::cluster

#pragma once
// A divided scene as a structure for queries.

#include "accel/core/accelerator.hpp"
#include "harness/thesis/cluster/split/light_exchange.hpp"
#include "harness/thesis/cluster/split/part_tracer.hpp"

namespace beambench::cluster {

/// The structure on process 0 that combines all processes. The querying threads trace rays up to
/// the border of this part, and submit those that reach it to the exchange. So each query is one
/// round, whether for a batch of many rays or for a single ray.
class DividedScene : public accel::Accelerator {
 public:
  /// `part` and `exchange` must outlive this object. `statistics` are those of this part.
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

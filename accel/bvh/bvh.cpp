// The hierarchies in the registry.

#include "accel/bvh/goldsmith_salmon.hpp"
#include "accel/bvh/sah_bvh.hpp"
#include "accel/core/instruction_set.hpp"
#include "accel/core/registry.hpp"

namespace beambench::accel::bvh {

void register_bvh(Registry& registry) {
  registry.add({"goldsmith-salmon",
                "a hierarchy of bounding volumes: Goldsmith and Salmon's insertion (1987), Kay and "
                "Kajiya's queue (1986); the thesis's with insert=terminal",
                Conformance::kBitExact, GoldsmithSalmonOptions::parameters(),
                [](const scenes::Scene& scene, const Parameters& parameters, const Workload&) {
                  return std::make_unique<GoldsmithSalmon>(
                      scene, GoldsmithSalmonOptions::from(parameters));
                }});
  registry.add({"sah-bvh",
                "today's baseline: a binned SAH hierarchy (Wald 2007), eight children per node, "
                "single rays by SIMD",
                Conformance::kBitExact, SahBvh::parameters(),
                [](const scenes::Scene& scene, const Parameters& parameters, const Workload&) {
                  return std::make_unique<SahBvh>(scene, SahBvh::options_from(parameters),
                                                  targets_of(parameters.choice("isa")));
                }});
  registry.describe_counters("sah-bvh", stream_counters());
}

std::vector<CounterInfo> stream_counters() {
  return {
      {"confirmed_tests",
       "primitives that the SIMD float test did not decide (for single rays: did not reject) "
       "and that the canonical test in double tested again"},
      {"stream_lists", "visits of a node by a list of rays"},
      {"stream_rays", "rays in these lists; divided by stream_lists, it is the mean list length"},
      {"stream_chunks", "groups of up to 16 rays tested against a node or a leaf together"},
      {"stream_packets", "lists of up to 16 rays that continued in registers"},
      {"stream_singles", "rays of lists that continued singly below a node"},
      {"stream_left", "rays that streams cannot trace, traced singly from the root"}};
}

}  // namespace beambench::accel::bvh

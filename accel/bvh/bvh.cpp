// The hierarchies that the registry knows.

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
       "primitives that the test in float by SIMD did not decide (of single rays: did not "
       "reject), and that were tested again by the canonical test in double"},
      {"stream_lists", "visits of a node by a list of rays"},
      {"stream_rays", "rays in these lists: divided by the lists, those of one"},
      {"stream_chunks", "groups of up to 16 rays tested against a node or a leaf together"},
      {"stream_packets", "lists of up to 16 rays that went on in registers"},
      {"stream_singles", "rays of lists that went on alone below some node"},
      {"stream_left", "rays that a stream does not take, which were traced alone from the root"}};
}

}  // namespace beambench::accel::bvh

#include "accel/octree/samet.hpp"

#include "accel/core/registry.hpp"
#include "accel/octree/choose_octree.hpp"
#include "accel/octree/leaf_walk.hpp"

namespace beambench::accel::octree {

void register_octree(Registry& registry) {
  registry.add(
      {"samet",
       "the octree of the thesis with Samet's 1989 traversal: explicit exit point, "
       "neighbors found over the nearest common ancestor",
       Conformance::kBitExact, OctreeOptions::parameters(),
       [](const scenes::Scene& scene, const Parameters& parameters, const Workload& workload) {
         return std::make_unique<Samet>(scene, choose_octree(scene, OctreeOptions::from(parameters),
                                                             workload, samet_trace_cost));
       }});
  registry.add(
      {"samet-net",
       "the octree and the traversal of samet, each face linked beforehand to the "
       "neighbor of equal or larger size (Endl and Sommer 1994)",
       Conformance::kBitExact, OctreeOptions::parameters(),
       [](const scenes::Scene& scene, const Parameters& parameters, const Workload& workload) {
         return std::make_unique<SametNet>(
             scene,
             choose_octree(scene, OctreeOptions::from(parameters), workload, samet_trace_cost));
       }});
  for (const char* structure : {"samet", "samet-net"}) {
    registry.describe_counters(structure,
                               {{std::string(kNeighborSteps), std::string(kNeighborStepsMeaning)}});
  }
}

}  // namespace beambench::accel::octree

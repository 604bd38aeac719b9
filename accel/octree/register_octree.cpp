// The structures over the octree: one octree, four ways to find the leaves along a ray.

#include <memory>
#include <string>
#include <utility>

#include "accel/core/registry.hpp"
#include "accel/octree/choose_octree.hpp"
#include "accel/octree/from_root.hpp"
#include "accel/octree/samet.hpp"
#include "scenes/base/error.hpp"

namespace beambench::accel::octree {
namespace {

template <class Structure>
void add(Registry& registry, std::string name, std::string summary) {
  registry.add(
      {std::move(name), std::move(summary), Conformance::kBitExact, OctreeOptions::parameters(),
       [](const scenes::Scene& scene, const Parameters& parameters, const Workload& workload) {
         return std::make_unique<Structure>(
             scene,
             choose_octree(scene, OctreeOptions::from(parameters), workload, samet_trace_cost));
       }});
}

/// Registers a structure that is traversed from the root down.
template <class Central, class AnyPlanes, class OnDemand>
std::unique_ptr<Accelerator> build_top_down(const scenes::Scene& scene,
                                            const Parameters& parameters,
                                            const Workload& workload) {
  const OctreeOptions options = OctreeOptions::from_top_down(parameters);
  if (options.build == OctreeOptions::Build::kOnDemand) {
    if (options.max_level == OctreeOptions::kAutomatic) {
      throw InputError(
          "build=on-demand: max_level is auto, for which complete octrees would have to be built; "
          "give it a number from 1 to 16");
    }
    return std::make_unique<OnDemand>(scene, options);
  }
  Octree octree = choose_octree(scene, options, workload, samet_trace_cost);
  if (octree.has_central_planes()) return std::make_unique<Central>(scene, std::move(octree));
  return std::make_unique<AnyPlanes>(scene, std::move(octree));
}

}  // namespace

void register_octree(Registry& registry) {
  add<Samet>(registry, "samet",
             "the octree of the thesis with Samet's 1989 traversal: explicit exit point, "
             "neighbors found over the nearest common ancestor");
  add<SametNet>(registry, "samet-net",
                "the octree and the traversal of samet, each face linked beforehand to the "
                "neighbor of equal or larger size (Endl and Sommer 1994)");
  registry.add({"glassner",
                "the octree of samet, the next leaf searched from the root each time (Glassner "
                "1984)",
                Conformance::kBitExact, OctreeOptions::top_down_parameters(),
                build_top_down<Glassner, GlassnerAnyPlanes, GlassnerOnDemand>});
  registry.add({"gargantini",
                "the octree of samet, traversed from the root down in the order of the ray's "
                "parameters at the planes between children (Gargantini and Atkinson 1993)",
                Conformance::kBitExact, OctreeOptions::top_down_parameters(),
                build_top_down<Gargantini, GargantiniAnyPlanes, GargantiniOnDemand>});
  const CounterInfo neighbor_steps{std::string(kNeighborSteps), std::string(kNeighborStepsMeaning)};
  registry.describe_counters(
      "samet", {neighbor_steps, {std::string(kLastClimb), std::string(kLastClimbMeaning)}});
  registry.describe_counters("samet-net", {neighbor_steps});
}

}  // namespace beambench::accel::octree

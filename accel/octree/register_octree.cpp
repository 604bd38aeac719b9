// The structures over the octree: one octree, four ways to find the leaves along a ray.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "accel/core/registry.hpp"
#include "accel/octree/choose_octree.hpp"
#include "accel/octree/from_root.hpp"
#include "accel/octree/outside_list.hpp"
#include "accel/octree/samet.hpp"
#include "scenes/base/error.hpp"

namespace beambench::accel::octree {
namespace {

/// Registers a structure over the thesis's own octree.
template <class Structure>
void add(Registry& registry, std::string name, std::string summary) {
  std::vector<ParameterInfo> parameters = OctreeOptions::parameters();
  parameters.push_back(real_parameter(
      "outside", 0.0, 0.0, 1.0,
      "objects larger than this fraction of the scene's size stay outside the octree, in a "
      "list that each ray is tested against (thesis, section 4.4); 0: none"));
  registry.add({std::move(name), std::move(summary), Conformance::kBitExact, std::move(parameters),
                [](const scenes::Scene& scene, const Parameters& given,
                   const Workload& workload) -> std::unique_ptr<Accelerator> {
                  const OctreeOptions options = OctreeOptions::from(given);
                  if (const double largest = given.real("outside"); largest > 0.0) {
                    return std::make_unique<WithOutsideList<Structure>>(scene, options, largest,
                                                                        workload);
                  }
                  return std::make_unique<Structure>(
                      scene, choose_octree(scene, options, workload, samet_trace_cost));
                }});
}

/// Builds a structure that is traversed from the root down.
template <class Central, class AnyPlanes, class OnDemand, class Hashed>
std::unique_ptr<Accelerator> build_top_down(const scenes::Scene& scene,
                                            const OctreeOptions& options,
                                            const Workload& workload) {
  if (options.build == OctreeOptions::Build::kOnDemand) {
    if (options.max_level == OctreeOptions::kAutomatic) {
      throw InputError(
          "build=on-demand: max_level is auto, which would require building complete octrees; "
          "give max_level a number from 1 to 16");
    }
    return std::make_unique<OnDemand>(scene, options);
  }
  Octree octree = choose_octree(scene, options, workload, samet_trace_cost);
  if (options.build == OctreeOptions::Build::kHashed) {
    return std::make_unique<Hashed>(scene, HashedOctree(std::move(octree)));
  }
  if (octree.has_central_planes()) return std::make_unique<Central>(scene, std::move(octree));
  return std::make_unique<AnyPlanes>(scene, std::move(octree));
}

std::unique_ptr<Accelerator> build_glassner(const scenes::Scene& scene,
                                            const Parameters& parameters,
                                            const Workload& workload) {
  const OctreeOptions options = OctreeOptions::from_root_search(parameters);
  if (options.exits == OctreeOptions::Exits::kExplicit) {
    return build_top_down<Glassner, GlassnerAnyPlanes, GlassnerOnDemand, GlassnerHashed>(
        scene, options, workload);
  }
  // Arbitrary planes have already been rejected.
  return build_top_down<GlassnerIterative, GlassnerIterative, GlassnerIterativeOnDemand,
                        GlassnerIterativeHashed>(scene, options, workload);
}

std::unique_ptr<Accelerator> build_gargantini(const scenes::Scene& scene,
                                              const Parameters& parameters,
                                              const Workload& workload) {
  return build_top_down<Gargantini, GargantiniAnyPlanes, GargantiniOnDemand, GargantiniHashed>(
      scene, OctreeOptions::from_top_down(parameters), workload);
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
                Conformance::kBitExact, OctreeOptions::root_search_parameters(), build_glassner});
  registry.add({"gargantini",
                "the octree of samet, traversed from the root down in the order of the ray's "
                "parameters at the planes between children (Gargantini and Atkinson 1993)",
                Conformance::kBitExact, OctreeOptions::top_down_parameters(), build_gargantini});
  const CounterInfo neighbor_steps{std::string(kNeighborSteps), std::string(kNeighborStepsMeaning)};
  registry.describe_counters(
      "samet", {neighbor_steps, {std::string(kLastClimb), std::string(kLastClimbMeaning)}});
  registry.describe_counters("samet-net", {neighbor_steps});
  registry.describe_counters("glassner",
                             {{std::string(kPlaneSteps), std::string(kPlaneStepsMeaning)}});
}

}  // namespace beambench::accel::octree

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "accel/beam/beam_cost.hpp"
#include "accel/beam/beam_counters.hpp"
#include "accel/beam/beam_options.hpp"
#include "accel/beam/beam_tracer.hpp"
#include "accel/core/registry.hpp"
#include "accel/octree/leaf_walk.hpp"
#include "accel/octree/samet.hpp"
#include "scenes/base/error.hpp"

namespace beambench::accel::beam {

namespace {

constexpr const char* kName = "beam";

octree::Octree chosen_octree(const scenes::Scene& scene, const BeamOptions& options,
                             const Workload& workload) {
  const auto handover = static_cast<double>(options.handover);
  return octree::choose_octree(
      scene, options.octree, workload,
      [handover](const octree::OctreeWork& work) { return beam_trace_cost(work, handover); },
      [&](const octree::Octree& octree, const octree::OctreeWork& expected,
          octree::OctreeWork& work) { count_beams(octree, workload, expected, work); });
}

}  // namespace

std::unique_ptr<BeamTracer> build_beam_tracer(const StructureChoice& choice,
                                              const scenes::Scene& scene,
                                              const Workload& workload) {
  if (choice.info().name != kName) {
    throw InputError(
        fmt::format("'{}' does not trace beams; give --accel beam, with or without parameters",
                    choice.info().name));
  }
  // This name is registered below with this type, and plug-ins cannot use it.
  return std::unique_ptr<BeamTracer>(
      static_cast<BeamTracer*>(choice.build(scene, workload).release()));
}

void register_beam(Registry& registry) {
  registry.add(
      {kName,
       "the beam tracer of the thesis: primary rays, and rays that planes reflect and refract, "
       "in beams through samet's octree; individual rays where a beam meets objects",
       Conformance::kBitExact, BeamOptions::parameters(),
       [](const scenes::Scene& scene, const Parameters& parameters, const Workload& workload) {
         const BeamOptions options = BeamOptions::from(parameters);
         return std::make_unique<BeamTracer>(scene, chosen_octree(scene, options, workload),
                                             options);
       }});
  std::vector<CounterInfo> counters = beam_counters();
  counters.emplace_back(std::string(octree::kNeighborSteps),
                        std::string(octree::kNeighborStepsMeaning));
  counters.emplace_back(std::string(octree::kLastClimb), std::string(octree::kLastClimbMeaning));
  registry.describe_counters(kName, std::move(counters));
}

std::vector<ParameterInfo> BeamOptions::parameters() {
  std::vector<ParameterInfo> parameters = octree::OctreeOptions::parameters();
  for (ParameterInfo& rule : BeamRules::parameters({})) parameters.push_back(std::move(rule));
  return parameters;
}

BeamOptions BeamOptions::from(const Parameters& parameters) {
  return {BeamRules::from(parameters), octree::OctreeOptions::from(parameters)};
}

}  // namespace beambench::accel::beam

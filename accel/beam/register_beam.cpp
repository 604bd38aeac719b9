#include "accel/beam/beam_cost.hpp"
#include "accel/beam/beam_tracer.hpp"
#include "accel/registry.hpp"

namespace beambench {

namespace {

Octree chosen_octree(const Scene& scene, const BeamOptions& options, const Workload& workload) {
  const auto handover = static_cast<double>(options.handover);
  return choose_octree(
      scene, options.octree, workload,
      [handover](const OctreeWork& work) { return beam_trace_cost(work, handover); },
      [&](const Octree& octree, const OctreeWork& expected, OctreeWork& work) {
        count_beams(octree, workload, expected, work);
      });
}

}  // namespace

void register_beam(Registry& registry) {
  registry.add({"beam",
                "the beam tracer of the thesis: primary rays in beams through samet's octree, "
                "individual rays where a beam meets objects",
                Conformance::kBitExact, BeamOptions::parameters(),
                [](const Scene& scene, const Parameters& parameters, const Workload& workload) {
                  const BeamOptions options = BeamOptions::from(parameters);
                  return std::make_unique<BeamTracer>(
                      scene, chosen_octree(scene, options, workload), options);
                }});
}

}  // namespace beambench

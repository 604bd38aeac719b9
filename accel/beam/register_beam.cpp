#include "accel/beam/beam_tracer.hpp"
#include "accel/registry.hpp"

namespace beambench {

void register_beam(Registry& registry) {
  registry.add({"beam",
                "the beam tracer of the thesis: primary rays in beams through samet's octree, "
                "individual rays where a beam meets objects",
                Conformance::kBitExact, BeamOptions::parameters(),
                [](const Scene& scene, const Parameters& parameters) {
                  return std::make_unique<BeamTracer>(scene, BeamOptions::from(parameters));
                }});
}

}  // namespace beambench

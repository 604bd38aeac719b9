#include "accel/tile_beam/tile_beam.hpp"

#include <hwy/targets.h>

#include "accel/core/registry.hpp"

namespace beambench::accel::tile_beam {

std::vector<ParameterInfo> TileBeam::parameters() {
  const TileHierarchyOptions defaults;
  return {integer_parameter("max_leaf", defaults.max_leaf, 1, 32, "most primitives of a leaf"),
          flag_parameter("parallel", defaults.parallel,
                         "build, and trace images, on all cores; the hits are the same"),
          isa_parameter()};
}

TileHierarchyOptions TileBeam::options_from(const Parameters& parameters) {
  TileHierarchyOptions options;
  options.max_leaf = static_cast<std::uint32_t>(parameters.integer("max_leaf"));
  options.parallel = parameters.flag("parallel");
  return options;
}

const char* TileBeam::instruction_set() const { return hwy::TargetName(kernels_->target); }

Statistics TileBeam::statistics() const {
  Statistics statistics;
  statistics.nodes = hierarchy_.nodes.size() + hierarchy_.leaves();
  statistics.leaves = hierarchy_.leaves();
  statistics.references = hierarchy_.references;
  statistics.depth = hierarchy_.depth;
  statistics.bytes = hierarchy_.nodes.capacity() * sizeof(TileNode) +
                     hierarchy_.meshlets.capacity() * sizeof(Meshlet) +
                     hierarchy_.spheres.capacity() * sizeof(SphereBlock) +
                     hierarchy_.cones.capacity() * sizeof(ConeBlock);
  statistics.instruction_set = instruction_set();
  statistics.image_rays = ImageRays::kOwn;
  statistics.more = {{"cost", hierarchy_.cost},
                     {"meshlets", static_cast<double>(hierarchy_.meshlets.size())}};
  return statistics;
}

void register_tile_beam(Registry& registry) {
  registry.add({"tile-beam",
                "beams the size of screen tiles through a wide hierarchy over meshlets, hits "
                "resolved by SIMD: the thesis's idea with today's means",
                Conformance::kTolerance, TileBeam::parameters(),
                [](const scenes::Scene& scene, const Parameters& parameters, const Workload&) {
                  return std::make_unique<TileBeam>(scene, TileBeam::options_from(parameters),
                                                    targets_of(parameters.choice("isa")));
                }});
  registry.describe_counters("tile-beam", {{"beams", "tiles of the image that were traced"}});
}

}  // namespace beambench::accel::tile_beam

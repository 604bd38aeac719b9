#include "accel/bvh/sah_bvh.hpp"

#include <hwy/targets.h>

namespace beambench::accel::bvh {

std::vector<ParameterInfo> SahBvh::parameters() {
  const BvhOptions defaults;
  return {choice_parameter("builder", "binned", {"binned", "spatial"},
                           "spatial: splits may divide primitives (Stich and others 2009)"),
          integer_parameter("max_leaf", defaults.max_leaf, 1, 32, "most primitives of a leaf"),
          flag_parameter("parallel", defaults.parallel,
                         "build on all cores; the hierarchy is the same")};
}

WideBvhOptions SahBvh::options_from(const Parameters& parameters) {
  WideBvhOptions options;
  options.splits.max_leaf = static_cast<std::uint32_t>(parameters.integer("max_leaf"));
  options.splits.parallel = parameters.flag("parallel");
  if (parameters.choice("builder") == "spatial") options.builder = BvhBuilder::kSpatial;
  return options;
}

const char* SahBvh::instruction_set() const { return hwy::TargetName(kernels_->target); }

Statistics SahBvh::statistics() const {
  Statistics statistics;
  statistics.nodes = bvh_.nodes.size() + bvh_.leaves;
  statistics.leaves = bvh_.leaves;
  statistics.references = bvh_.references;
  statistics.depth = bvh_.depth;
  statistics.bytes =
      bvh_.nodes.capacity() * sizeof(WideNode) + bvh_.blocks.capacity() * sizeof(PrimitiveBlock);
  statistics.instruction_set = instruction_set();
  statistics.more = {{"cost", bvh_.cost}};
  bvh_.visits.append_to(statistics);
  return statistics;
}

}  // namespace beambench::accel::bvh

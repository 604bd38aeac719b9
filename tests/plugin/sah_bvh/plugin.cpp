// The built-in sah-bvh under another name.

#include "harness/plugin/plugin.hpp"

#include <memory>

#include "accel/bvh/sah_bvh.hpp"
#include "accel/core/instruction_set.hpp"

const beambench::plugin::Plugin beambench_plugin{
    .description = "sah-bvh, built as a plug-in",
    .fill = [](beambench::plugin::PluginContents& contents) {
      contents.structures.push_back(
          {"plugged-sah-bvh", "the built-in sah-bvh under another name",
           beambench::accel::Conformance::kBitExact, beambench::accel::bvh::SahBvh::parameters(),
           [](const beambench::scenes::Scene& scene, const beambench::Parameters& parameters,
              const beambench::accel::Workload&) {
             return std::make_unique<beambench::accel::bvh::SahBvh>(
                 scene, beambench::accel::bvh::SahBvh::options_from(parameters),
                 beambench::accel::targets_of(parameters.choice("isa")));
           }});
    }};

// The built-in sah-bvh under another name.

#include "harness/plugin/plugin.hpp"

#include <memory>

#include "accel/bvh/sah_bvh.hpp"

const beambench::Plugin beambench_plugin{
    .description = "sah-bvh, built as a plug-in", .fill = [](beambench::PluginContents& contents) {
      contents.structures.push_back(
          {"plugged-sah-bvh", "the built-in sah-bvh under another name",
           beambench::Conformance::kBitExact, beambench::SahBvh::parameters(),
           [](const beambench::Scene& scene, const beambench::Parameters& parameters,
              const beambench::Workload&) {
             return std::make_unique<beambench::SahBvh>(
                 scene, beambench::SahBvh::options_from(parameters));
           }});
    }};

// The plug-in's entry point: its structures, their names and their parameters.

#include <cmath>
#include <memory>

#include "median_bvh.hpp"

namespace {

std::unique_ptr<beambench::accel::Accelerator> build_median_bvh(
    const beambench::scenes::Scene& scene, const beambench::Parameters& parameters,
    const beambench::accel::Workload&) {
  return std::make_unique<MedianBvh>(scene,
                                     static_cast<std::uint32_t>(parameters.integer("max_leaf")));
}

beambench::scenes::Scene generate_helix(const beambench::Parameters& parameters) {
  beambench::scenes::SceneBuilder builder(parameters.label());
  const auto count = parameters.integer("spheres");
  for (std::int64_t i = 0; i < count; ++i) {
    const double turn = 0.2 * static_cast<double>(i);
    builder.add_sphere({std::cos(turn), std::sin(turn), 0.02 * static_cast<double>(i)}, 0.08);
  }
  return std::move(builder).build();
}

}  // namespace

const beambench::plugin::Plugin beambench_plugin{
    .description = "A hierarchy to start from, and a scene to try it on",
    .fill = [](beambench::plugin::PluginContents& contents) {
      contents.structures.push_back(
          {"mine",
           "a binary hierarchy split at the median",
           beambench::accel::Conformance::kBitExact,
           {beambench::integer_parameter("max_leaf", 4, 1, 64, "maximum primitives per leaf")},
           build_median_bvh});
      contents.scenes.push_back(
          {"helix",
           "spheres on a helix",
           {beambench::integer_parameter("spheres", 200, 1, 100000, "number of spheres")},
           generate_helix});
    }};

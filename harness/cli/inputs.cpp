#include "harness/cli/inputs.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/rays/resolution.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/error.hpp"

namespace beambench {

Scene open_scene(std::string_view spec, NffOptions options) {
  std::vector<std::string> warnings;
  Scene scene = load_scene(spec, &warnings, options);
  for (const std::string& warning : warnings) fmt::print(stderr, "beambench: {}\n", warning);
  return scene;
}

const Camera& choose_camera(const Scene& scene, std::string_view name) {
  if (name.empty()) return scene.cameras.front();
  std::vector<std::string_view> names;
  for (const Camera& camera : scene.cameras) {
    if (camera.name == name) return camera;
    names.push_back(camera.name);
  }
  throw InputError(fmt::format("scene '{}' has no camera '{}'; choose from: {}", scene.name, name,
                               fmt::join(names, ", ")));
}

StructureChoice choose_one(std::string_view option, std::string_view text) {
  std::vector<StructureChoice> choices = registry().choose_list(text);
  if (choices.size() == 1) return choices.front();
  throw InputError(fmt::format("{} '{}' names {} structures, but one is shown at a time; name one",
                               option, text, choices.size()));
}

ImageOfRays choose_image(const Scene& scene, const ImageRequest& request) {
  const Camera& camera = choose_camera(scene, request.camera);
  const Resolution resolution = request.resolution.empty() ? Resolution{camera.width, camera.height}
                                                           : parse_resolution(request.resolution);
  const auto samples = sample_offsets(request.samples).size();
  require_ray_count(resolution, static_cast<int>(samples));
  return {camera, resolution, request.samples};
}

PrimaryRays choose_rays(const Scene& scene, const ImageRequest& request) {
  const ImageOfRays image = choose_image(scene, request);
  return {image.camera, image.resolution.width, image.resolution.height, image.samples};
}

void add_image_options(CLI::App& command, ImageRequest& request) {
  command.add_option("--resolution", request.resolution, "WxH (default: the camera's own)");
  command.add_option("--samples", request.samples, "Rays a pixel: 1, 4, 5, 9, 16, ...")
      ->capture_default_str();
  command.add_option("--camera", request.camera, "By name (default: the scene's first)");
}

Contenders choose_contenders(std::string_view list, const Scene& scene) {
  Contenders contenders;
  const std::vector<Spec> specs = parse_spec_list(list);
  const auto named = [&](std::string_view name) {
    return std::any_of(specs.begin(), specs.end(),
                       [&](const Spec& spec) { return spec.name == name; });
  };
  contenders.choices = registry().choose_list(list);
  const bool too_many = scene.primitives.size() > kExhaustiveLimit;
  if (too_many && named("all") && !named("exhaustive")) {
    std::erase_if(contenders.choices,
                  [](const StructureChoice& choice) { return choice.info().name == "exhaustive"; });
    contenders.note = fmt::format(
        "{}: exhaustive is left out of 'all' above {} primitives (the scene has {}); name it after "
        "--accel to have it all the same",
        scene.name, kExhaustiveLimit, scene.primitives.size());
  }
  return contenders;
}

}  // namespace beambench

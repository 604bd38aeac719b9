#include "harness/cli/inputs.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <fmt/ranges.h>

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

std::string short_label(const StructureChoice& choice) {
  const auto values = choice.parameters().values();
  const std::vector<ParameterInfo>& infos = choice.info().parameters;
  std::vector<std::string> changed;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i].second != infos[i].default_value) {
      changed.push_back(values[i].first + '=' + values[i].second);
    }
  }
  const std::string& name = choice.info().name;
  return changed.empty() ? name : fmt::format("{}:{}", name, fmt::join(changed, ","));
}

}  // namespace beambench

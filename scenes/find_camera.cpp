#include "scenes/find_camera.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/core/error.hpp"
#include "scenes/core/nearest_name.hpp"

namespace beambench::scenes {

const Camera& find_camera(const Scene& scene, std::string_view name) {
  std::vector<std::string> names;
  for (const Camera& camera : scene.cameras) {
    if (camera.name == name) return camera;
    names.push_back(camera.name);
  }
  throw InputError(fmt::format("the scene {} has no camera '{}'; {}choose from: {}", scene.name,
                               name, did_you_mean(name, names), fmt::join(names, ", ")));
}

}  // namespace beambench::scenes

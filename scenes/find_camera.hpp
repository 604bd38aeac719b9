#pragma once
// A scene's cameras by name.

#include <string_view>

#include "scenes/scene.hpp"

namespace beambench::scenes {

/// The camera of that name. Throws InputError that lists the scene's cameras.
const Camera& find_camera(const Scene& scene, std::string_view name);

}  // namespace beambench::scenes

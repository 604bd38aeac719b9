#pragma once
// The catalogue's other door, for the loader of plug-ins alone.

#include <vector>

#include "scenes/catalogue.hpp"

namespace beambench::scenes {

/// Adds to `scene_catalogue()` and `scene_readers()`, whose spans end with it: for the time before
/// anyone has asked. What is added was checked (harness/plugin/check_contents.hpp).
void extend_catalogue(std::vector<SceneInfo> scenes, std::vector<SceneReader> readers);

}  // namespace beambench::scenes

#pragma once
// A scene that foreign code made, looked over before a structure is built over it.

#include "scenes/scene.hpp"

namespace beambench::plugin {

/// Throws PluginError with what is wrong when the scene is not as `SceneBuilder` makes them: an
/// index leaves its array, a number is not finite or beyond 1e9, a radius is no radius, the bounds
/// are not those of the primitives, or there is no camera. Whether polygons are well triangulated
/// is not looked at.
void check_scene(const scenes::Scene& scene);

}  // namespace beambench::plugin

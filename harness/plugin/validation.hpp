#pragma once
// What comes from a plug-in is validated before it is used.

#include "harness/plugin/plugin.hpp"
#include "scenes/scene.hpp"

namespace beambench::plugin {

/// Throws PluginError with what is wrong when the scene is not as `SceneBuilder` makes them: an
/// index leaves its array, a number is not finite or beyond 1e9, a radius is no radius, the bounds
/// are not those of the primitives, or there is no camera. The triangulation of polygons is not
/// checked.
void check_scene(const scenes::Scene& scene);

/// Throws PluginError with what is wrong: nothing is there, a name is taken, used twice or not a
/// name, a text or a function is missing, a parameter's default is out of range.
void check_contents(const PluginContents& contents);

}  // namespace beambench::plugin

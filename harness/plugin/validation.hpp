#pragma once
// Validates the contents of a plug-in before they are used.

#include "harness/plugin/plugin.hpp"
#include "scenes/scene.hpp"

namespace beambench::plugin {

/// Throws PluginError with the problem if `SceneBuilder` would not make such a scene: an index
/// outside its array, a number that is not finite or beyond 1e9, an invalid radius, bounds that are
/// not those of the primitives, or a missing camera. The triangulation of polygons is not checked.
void check_scene(const scenes::Scene& scene);

/// Throws PluginError with the problem: no contents, a name that is taken, duplicate or invalid, a
/// missing string or function, a parameter whose default is out of range.
void check_contents(const PluginContents& contents);

}  // namespace beambench::plugin

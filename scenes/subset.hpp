#pragma once
// Makes a scene from some primitives of another scene.

#include <span>

#include "scenes/scene.hpp"

namespace beambench::scenes {

/// Returns the primitives with these ids, in their order, bit for bit, each vertex once, with all
/// surfaces, lights and cameras. The bounds are those of the chosen primitives.
Scene subset(const Scene& scene, std::span<const PrimitiveId> ids);

}  // namespace beambench::scenes

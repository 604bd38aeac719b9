#pragma once
// Makes a scene from some primitives of another scene.

#include <span>

#include "scenes/scene.hpp"

namespace beambench::scenes {

/// Returns a scene of the primitives with these ids, in the order of the ids and bit for bit, with
/// all surfaces, lights and cameras. Each vertex is copied once. The bounds are those of the chosen
/// primitives.
Scene subset(const Scene& scene, std::span<const PrimitiveId> ids);

}  // namespace beambench::scenes

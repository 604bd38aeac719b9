#pragma once
// A scene of some primitives of another.

#include <span>

#include "scenes/scene.hpp"

namespace beambench::scenes {

/// The primitives with these ids, in their order, bit for bit, each vertex once, with all surfaces,
/// lights and cameras. Bounds are those of the chosen primitives.
Scene subset(const Scene& scene, std::span<const PrimitiveId> ids);

}  // namespace beambench::scenes

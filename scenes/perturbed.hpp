#pragma once
// Varies a scene, to tell what depends on it by accident.

#include <cstdint>

#include "scenes/scene.hpp"

namespace beambench::scenes {

/// Returns the scene with its objects moved and turned, and with other cameras, as the seed says.
/// An object is a sphere, a cone, or all polygons that share places of vertices. Each is moved by
/// up to 5% of its own size along each axis and turned by up to 10 degrees about an axis that is
/// vertical for the first camera. Objects larger than half of the scene, such as floors and walls,
/// stay where they are, unless there is no other. A camera is turned by up to 15 degrees about the
/// place that it looks at and moved by up to a tenth of the distance; inside the scene's box, where
/// something could come before it, it only turns in place. Primitives keep their order and
/// surfaces; lights stay. Throws InputError where a moved primitive is degenerate.
Scene perturbed(const Scene& scene, std::uint64_t seed);

}  // namespace beambench::scenes

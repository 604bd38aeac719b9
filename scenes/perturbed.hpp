#pragma once
// Varies a scene, to reveal results that hold only by accident.

#include <cstdint>

#include "scenes/scene.hpp"

namespace beambench::scenes {

/// Returns the scene with its objects and cameras moved and turned at random, determined by the
/// seed. An object is a sphere, a cone, or all polygons connected by vertex positions. Each object
/// is moved by up to 5% of its own size along each axis and turned by up to 10 degrees about an
/// axis that is vertical for the first camera. Objects larger than half of the scene, such as
/// floors and walls, stay in place unless all objects are that large. A camera is turned by up to
/// 15 degrees about the point it looks at and moved by up to a tenth of its distance from that
/// point. Inside the scene's box, where something could block its view, it only turns in place.
/// Primitives keep their order and surfaces; lights stay. Throws InputError if a moved primitive is
/// degenerate.
Scene perturbed(const Scene& scene, std::uint64_t seed);

}  // namespace beambench::scenes

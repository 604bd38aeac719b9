#pragma once

#include <glm/vec3.hpp>

namespace beambench::scenes::generators {

/// The background that nearly all scenes of Haines's SPD share.
inline constexpr glm::dvec3 kSpdSky(0.078, 0.361, 0.753);

}  // namespace beambench::scenes::generators

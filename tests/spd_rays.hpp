#pragma once
// The rays that published counts of the Standard Procedural Databases were made with.

#include <cstdint>
#include <vector>

#include "accel/core/ray.hpp"
#include "scenes/scene.hpp"

namespace beambench::tests {

/// Rays through the corners of 512 x 512 pixels, 513 x 513 of them, and from where they hit a
/// shadow ray to each light that the seen side of the polygon faces.
struct SpdRays {
  std::vector<accel::Ray> eye;
  std::vector<accel::Ray> shadow;  ///< t_max = 1 is the light
  std::uint64_t eye_hits = 0;

  std::size_t size() const { return eye.size() + shadow.size(); }
};

/// The rays over a scene of polygons.
SpdRays spd_rays(const scenes::Scene& scene);

}  // namespace beambench::tests

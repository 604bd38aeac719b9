#pragma once
// The rays of the published counts for the Standard Procedural Databases.

#include <cstdint>
#include <vector>

#include "accel/core/ray.hpp"
#include "scenes/scene.hpp"

namespace beambench::tests {

/// Eye rays through the corners of 512 x 512 pixels, which are 513 x 513 rays, and from each hit a
/// shadow ray to each light that the visible side of the polygon faces.
struct SpdRays {
  std::vector<accel::Ray> eye;
  std::vector<accel::Ray> shadow;  ///< the light is at t_max = 1
  std::uint64_t eye_hits = 0;

  std::size_t size() const { return eye.size() + shadow.size(); }
};

/// Returns the rays over a scene of polygons.
SpdRays spd_rays(const scenes::Scene& scene);

}  // namespace beambench::tests

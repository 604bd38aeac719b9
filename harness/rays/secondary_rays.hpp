#pragma once
// Rays that start where primary rays hit.

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/primary_rays.hpp"
#include "scenes/scene.hpp"

namespace beambench::rays {

/// Where a primary ray meets a surface.
struct PrimaryHitPoint {
  glm::dvec3 point;
  glm::dvec3 normal;    ///< unit length, geometric, on the side that the ray comes from
  glm::dvec3 incoming;  ///< the ray's direction, unit length
};

/// Where the primary rays hit, in their order, by the oracle (on all cores): so the rays that start
/// here are the same whatever structure is asked.
std::vector<PrimaryHitPoint> surface_points(const scenes::Scene& scene,
                                            const accel::PrimaryRays& rays);

/// All secondary rays start `beside_surface`, on the side of the primary ray.
///
/// To each light that the surface faces, point by point: t in [0, 1], the light being at 1.
std::vector<accel::Ray> shadow_rays(const scenes::Scene& scene,
                                    const std::vector<PrimaryHitPoint>& points);

/// The mirror direction of the incoming ray, of unit length.
std::vector<accel::Ray> reflection_rays(const scenes::Scene& scene,
                                        const std::vector<PrimaryHitPoint>& points);

/// One direction a point with density cos / pi about the normal, of unit length.
std::vector<accel::Ray> diffuse_rays(const scenes::Scene& scene,
                                     const std::vector<PrimaryHitPoint>& points,
                                     std::uint64_t seed);

}  // namespace beambench::rays

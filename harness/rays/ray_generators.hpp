#pragma once
// Secondary rays, which start where primary rays hit, and random rays.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/primary_rays.hpp"
#include "accel/core/ray.hpp"
#include "scenes/bounds.hpp"
#include "scenes/scene.hpp"

namespace beambench::rays {

/// Where a primary ray meets a surface.
struct PrimaryHitPoint {
  glm::dvec3 point;
  glm::dvec3 normal;    ///< unit length, geometric, on the side that the ray comes from
  glm::dvec3 incoming;  ///< the ray's direction, unit length
};

/// Where the primary rays hit, in their order, by the oracle (on all cores): the rays that start
/// here are the same for every structure.
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

/// One direction per point with density cos / pi about the normal, of unit length.
std::vector<accel::Ray> diffuse_rays(const scenes::Scene& scene,
                                     const std::vector<PrimaryHitPoint>& points,
                                     std::uint64_t seed);

/// `count` rays that are uniform among all lines through the box, by the measure of lines that does
/// not change when space is moved or turned (Santalo, Integral Geometry, 1976, II.12): they enter
/// at points uniform on its surface, with density cos / pi about the inward normal. The probability
/// to meet a convex body in the box is then its surface area over the box's. They start one
/// diagonal before the box, with directions of unit length. The box is widened by 2^-10 of its
/// diagonal, so that it has an inside. None for an empty box.
std::vector<accel::Ray> random_rays(const scenes::Bounds& box, std::size_t count,
                                    std::uint64_t seed);

}  // namespace beambench::rays

#pragma once
// Generates secondary rays, which start at the hits of primary rays, and random rays.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/primary_rays.hpp"
#include "harness/rays/ray_set.hpp"
#include "harness/rays/virtual_eye.hpp"
#include "scenes/bounds.hpp"
#include "scenes/scene.hpp"

namespace beambench::rays {

/// The place where a ray meets a surface. Rays that start there have their origin at distance
/// `lift` from it, on the side from which the ray comes (`MirrorTable::lift_at`). Geometry alone
/// then decides whether the surface itself is hit again, and rays need no t_min.
struct SurfacePoint {
  glm::dvec3 beside() const { return point + normal * lift; }

  glm::dvec3 point;
  glm::dvec3 normal;    ///< unit length, geometric, on the side that the ray comes from
  glm::dvec3 incoming;  ///< the direction of the incoming ray, unit length
  double lift;
  scenes::PrimitiveId primitive;
  std::uint32_t sample;  ///< the sample the ray comes from, as numbered by a HitBuffer of the image
};

/// Returns the hits of the primary rays, in order, found by the oracle (on all cores), so rays that
/// start at these points are the same for every structure.
std::vector<SurfacePoint> surface_points(const scenes::Scene& scene, const MirrorTable& mirrors,
                                         const accel::PrimaryRays& rays);
inline std::vector<SurfacePoint> surface_points(const scenes::Scene& scene,
                                                const accel::PrimaryRays& rays) {
  return surface_points(scene, MirrorTable(scene), rays);
}

/// Returns the same points in the order of `for_each_sample`.
std::vector<SurfacePoint> in_picture_order(const std::vector<SurfacePoint>& points,
                                           const accel::PrimaryRays& image);

/// All secondary rays start `beside` the surface, and store the sample of their primary ray.
///
/// Returns the shadow rays, light by light, from each point that faces the light. The light is at t
/// = 1, and the rays end slightly before it (`accel::t_before_light`). Each light is a pencil.
/// Every `per_light` successive `lights` are the points of one light with an extent
/// (`area_lights`): a surface point that faces any of them sends rays to all of them, and their
/// pencils form a bundle.
RayList shadow_rays(std::span<const scenes::Light> lights, const std::vector<SurfacePoint>& points,
                    std::size_t per_light = 1);

/// Returns rays in the mirror directions of the incoming rays, of unit length.
RayList reflection_rays(const std::vector<SurfacePoint>& points);

/// Returns reflection rays only for points on planar mirrors, mirror by mirror. Unless a mirror is
/// seen edge-on, its rays are a pencil that runs away from the image's eye behind it
/// (`VirtualEye::behind`).
RayList mirror_rays(const std::vector<SurfacePoint>& points, const MirrorTable& mirrors,
                    const accel::PrimaryRays& image);

/// Returns one ray per point, with a direction of unit length and density cos / pi about the
/// normal.
RayList diffuse_rays(const std::vector<SurfacePoint>& points, std::uint64_t seed);

/// Returns `samples` rays from each point, one after the other, with directions like those of
/// diffuse rays and t in [0, distance], in units of the scene.
RayList occlusion_rays(const std::vector<SurfacePoint>& points, int samples, float distance,
                       std::uint64_t seed);

/// Returns diffuse rays, then diffuse rays from their hits (found by the oracle, on all cores), and
/// so on for `bounces` bounces, or until all paths have left the scene. The first rays are those of
/// `diffuse_rays`.
RayList path_rays(const scenes::Scene& scene, const MirrorTable& mirrors,
                  std::vector<SurfacePoint> points, int bounces, std::uint64_t seed);

/// Returns `count` rays that are uniform among all lines through the box, by the measure of lines
/// that is invariant under motions (Santalo, Integral Geometry, 1976, II.12): they enter at points
/// uniform on its surface, with density cos / pi about the inward normal. So a ray meets a convex
/// body in the box with a probability equal to the ratio of their surface areas. The rays start one
/// diagonal in front of the box, with directions of unit length. The box is widened by 2^-10 of its
/// diagonal, so that it has an interior. Returns no rays for an empty box.
RayList random_rays(const scenes::Bounds& box, std::size_t count, std::uint64_t seed);

}  // namespace beambench::rays

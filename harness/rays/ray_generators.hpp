#pragma once
// Secondary rays, which start where primary rays hit, and random rays.

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/primary_rays.hpp"
#include "harness/rays/ray_set.hpp"
#include "harness/rays/virtual_eye.hpp"
#include "scenes/bounds.hpp"
#include "scenes/scene.hpp"

namespace beambench::rays {

/// Where a ray meets a surface, and where the rays begin that start there: `lift` beside it, on the
/// side that the ray comes from (`MirrorTable::lift_at`). Geometry alone then decides whether the
/// surface itself is met again, and rays need no t_min.
struct SurfacePoint {
  glm::dvec3 beside() const { return point + normal * lift; }

  glm::dvec3 point;
  glm::dvec3 normal;    ///< unit length, geometric, on the side that the ray comes from
  glm::dvec3 incoming;  ///< the ray's direction, unit length
  double lift;
  scenes::PrimitiveId primitive;
  std::uint32_t sample;  ///< that the ray comes from, as a HitBuffer of the image numbers them
};

/// Where the primary rays hit, in their order, by the oracle (on all cores): the rays that start
/// here are the same for every structure.
std::vector<SurfacePoint> surface_points(const scenes::Scene& scene, const MirrorTable& mirrors,
                                         const accel::PrimaryRays& rays);
inline std::vector<SurfacePoint> surface_points(const scenes::Scene& scene,
                                                const accel::PrimaryRays& rays) {
  return surface_points(scene, MirrorTable(scene), rays);
}

/// The same points in the order of `for_each_sample`.
std::vector<SurfacePoint> in_picture_order(const std::vector<SurfacePoint>& points,
                                           const accel::PrimaryRays& image);

/// All secondary rays start `beside` the surface, and name the sample of the primary ray.
///
/// Light by light, from each point that faces the light, which is at t = 1: the rays end a little
/// before it (`accel::t_before_light`). Each light is a pencil.
RayList shadow_rays(const scenes::Scene& scene, const std::vector<SurfacePoint>& points);

/// The mirror direction of the incoming ray, of unit length.
RayList reflection_rays(const std::vector<SurfacePoint>& points);

/// The same at the points of planar mirrors alone, mirror by mirror. Each mirror is a pencil, away
/// from the image's eye behind it, unless it is seen from its edge (`VirtualEye::behind`).
RayList mirror_rays(const std::vector<SurfacePoint>& points, const MirrorTable& mirrors,
                    const accel::PrimaryRays& image);

/// One direction per point with density cos / pi about the normal, of unit length.
RayList diffuse_rays(const std::vector<SurfacePoint>& points, std::uint64_t seed);

/// `samples` rays from each point, one after the other, with directions as those of diffuse rays:
/// t in [0, distance], which is in units of the scene.
RayList occlusion_rays(const std::vector<SurfacePoint>& points, int samples, float distance,
                       std::uint64_t seed);

/// Diffuse rays, from where these hit (by the oracle, on all cores) diffuse rays again, and so on
/// for `bounces` times; fewer when all paths have left the scene. The first are `diffuse_rays`.
RayList path_rays(const scenes::Scene& scene, const MirrorTable& mirrors,
                  std::vector<SurfacePoint> points, int bounces, std::uint64_t seed);

/// `count` rays that are uniform among all lines through the box, by the measure of lines that does
/// not change when space is moved or turned (Santalo, Integral Geometry, 1976, II.12): they enter
/// at points uniform on its surface, with density cos / pi about the inward normal. The probability
/// to meet a convex body in the box is then its surface area over the box's. They start one
/// diagonal before the box, with directions of unit length. The box is widened by 2^-10 of its
/// diagonal, so that it has an inside. None for an empty box.
RayList random_rays(const scenes::Bounds& box, std::size_t count, std::uint64_t seed);

}  // namespace beambench::rays

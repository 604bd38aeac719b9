#pragma once
// Which way a surface faces where a ray meets it.

#include <glm/vec3.hpp>

#include "accel/core/ray.hpp"
#include "scenes/scene.hpp"

namespace beambench::rays {

/// The unit normal of the primitive hit, at the hit, on the side that the ray comes from. On a
/// polygon: that of the triangle in which the point lies deepest.
glm::dvec3 geometric_normal(const scenes::Scene& scene, const accel::Ray& ray,
                            const accel::Hit& hit);

/// The same, but on a smooth polygon interpolated between the corners' normals: what shading uses.
glm::dvec3 shading_normal(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& hit);

}  // namespace beambench::rays

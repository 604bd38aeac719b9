#pragma once
// Turns the hits of an image into a picture, and defines the laws of reflection used everywhere.

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/core/ray.hpp"
#include "harness/render/picture/image.hpp"
#include "scenes/scene.hpp"

namespace beambench::render {

/// Returns Phong's highlight (CACM 18(6), 1975): how close the eye is to the mirror direction of
/// the light; `cosine` is the cosine of the angle between them.
inline double phong(double cosine, double shine) {
  return cosine > 0.0 ? std::pow(cosine, std::max(shine, 1.0)) : 0.0;
}
/// Returns the highlight for directions, all of unit length.
inline double phong(const glm::dvec3& normal, const glm::dvec3& to_light, const glm::dvec3& to_eye,
                    double shine) {
  return phong(glm::dot(accel::mirrored(-to_light, normal), to_eye), shine);
}

/// Returns the direction of a ray behind a surface, by Snell's law; nothing at total reflection.
/// `incoming` and `normal` have unit length, and the normal points to the side from which the ray
/// comes; `ratio` is the index of refraction in front of the surface over that behind it. The
/// result has unit length (Heckbert, "Writing a ray tracer", in Glassner, An Introduction to Ray
/// Tracing, 1989).
inline std::optional<glm::dvec3> refracted(const glm::dvec3& incoming, const glm::dvec3& normal,
                                           double ratio) {
  const double cosine = -glm::dot(incoming, normal);
  const double behind = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
  if (behind < 0.0) return std::nullopt;
  return glm::normalize(ratio * incoming + (ratio * cosine - std::sqrt(behind)) * normal);
}

/// Returns linear light for a hit: Lambert and Phong under the scene's lights and a headlight at
/// the camera, without shadows. The headlight keeps all visible sides from being black. The scene's
/// colors are display values, as was usual in 1987, and are first decoded to linear light.
glm::vec3 preview_color(const scenes::Scene& scene, const accel::Ray& ray, const accel::Hit& hit);

/// Returns linear light for a miss.
glm::vec3 background_color(const scenes::Scene& scene);

/// The quantity shown for a hit.
enum class Shading {
  kPreview,  ///< surface colors under the scene's lights and a headlight, without shadows
  kNormals,  ///< the surface's direction: x, y, z as red, green, blue
  kId,       ///< a color for each primitive
  kDepth,    ///< nearer is brighter
  kWhitted   ///< the whole ray tracer (`Whitted`), which needs more than hits
};

/// The names after --shade, in the order of `Shading`.
std::span<const std::string_view> shading_names();
/// Throws InputError listing the valid names.
Shading parse_shading(std::string_view name);

/// Computes each pixel as the mean of its samples. `hits` are the hits of `rays`. Throws
/// std::invalid_argument for kWhitted.
Image shade(const scenes::Scene& scene, const accel::PrimaryRays& rays,
            const accel::HitBuffer& hits, Shading shading);

}  // namespace beambench::render

#pragma once
// An image seen through planes that reflect and refract, by an eye that drifts from place to place.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "accel/core/primary_rays.hpp"
#include "accel/core/ray.hpp"

namespace beambench::accel::beam {

/// A sample's pixel and its number in the pixel.
struct SamplePlace {
  glm::ivec2 pixel;
  std::size_t sample;
};

/// Returns the place of a sample that is numbered as in a HitBuffer of the image.
inline SamplePlace place_in(const PrimaryRays& image, std::uint32_t sample) {
  const auto samples = static_cast<std::uint32_t>(image.samples());
  const auto width = static_cast<std::uint32_t>(image.width());
  const std::uint32_t pixel = sample / samples;
  return {{pixel % width, pixel / width}, sample % samples};
}

/// How a ray runs beside the line that belongs to its sample. Angles, and the distance from the
/// center, are lengths at view depth 1; other lengths are those of the scene.
struct Course {
  double start;               ///< view depth of its origin
  double deviation;           ///< angle at the drifting eye, from the origin on
  double deviation_from_eye;  ///< angle at the eye
  double beside_eye;          ///< distance at which its line passes the eye
  double drifted;             ///< the part of it that the drift explains
  double from_center;         ///< distance of its sample's place from the center
};

/// The line of a sample at a place p, in [0, 1] x [0, 1], passes through the point eye + drift[0] *
/// (p - center).x + drift[1] * (p - center).y in the direction that the image has there. A planar
/// mirror shows such an image without drift. Behind a plane that refracts, rays from a point have
/// no common point, but in a small part of the image such lines come close to them: the linear
/// approximation of pencil tracing (Shinya, Takahashi and Naito, "Principles and applications of
/// pencil tracing", SIGGRAPH 1987).
struct DriftingView {
  PrimaryRays image;
  glm::dvec3 eye;
  glm::dvec2 center{0.0};
  std::array<glm::dvec3, 2> drift{};

  /// Returns how a ray runs; with an infinite deviation if it runs toward the eye, or from behind
  /// it.
  Course course_of(const Ray& ray, const SamplePlace& place) const;
  /// The smaller of a pixel's width and height at view depth 1.
  double pixel() const;
};

/// Returns the view that is closest, by least squares, to rays whose samples are those of an image.
/// Nothing if all samples lie near one line, or if rays run in all directions. Every tenth of many
/// rays gives nearly the same view as all of them.
std::optional<DriftingView> fitted_view(std::span<const Ray> rays,
                                        std::span<const std::uint32_t> samples,
                                        const PrimaryRays& image);

}  // namespace beambench::accel::beam

#pragma once
// An image seen through reflecting and refracting planes by an eye that drifts across the image.

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

/// Returns the place of a sample numbered as in a HitBuffer of the image.
inline SamplePlace place_in(const PrimaryRays& image, std::uint32_t sample) {
  const auto samples = static_cast<std::uint32_t>(image.samples());
  const auto width = static_cast<std::uint32_t>(image.width());
  const std::uint32_t pixel = sample / samples;
  return {{pixel % width, pixel / width}, sample % samples};
}

/// The deviation of a ray from the line of its sample. Angles and the distance from the center are
/// lengths at view depth 1; other lengths are in scene units.
struct Course {
  double start;               ///< view depth of its origin
  double deviation;           ///< angle at the drifting eye, from the ray's origin on
  double deviation_from_eye;  ///< angle at the eye
  double beside_eye;          ///< distance of its line from the eye
  double drifted;             ///< the part of `beside_eye` that the drift explains
  double from_center;         ///< distance of its sample's place from the center
};

/// An image whose eye drifts: the line of a sample at a place p, in [0, 1] x [0, 1], passes through
/// the point eye + drift[0] * (p - center).x + drift[1] * (p - center).y in the direction of the
/// image there. A planar mirror shows such an image without drift. Rays refracted by a plane have
/// no common point, but in a small part of the image such lines approximate them: the linear
/// approximation of pencil tracing (Shinya, Takahashi and Naito, "Principles and applications of
/// pencil tracing", SIGGRAPH 1987).
struct DriftingView {
  PrimaryRays image;
  glm::dvec3 eye;
  glm::dvec2 center{0.0};
  std::array<glm::dvec3, 2> drift{};

  /// Returns how a ray deviates; the deviation is infinite if it runs toward the eye or comes from
  /// behind it.
  Course course_of(const Ray& ray, const SamplePlace& place) const;
  /// Returns the smaller of a pixel's width and height at view depth 1.
  double pixel() const;
};

/// Fits a view, by least squares, to rays that come from samples of an image. Returns nothing if
/// all samples lie near one line or the rays run in all directions. For many rays, every tenth ray
/// yields nearly the same view as all of them.
std::optional<DriftingView> fitted_view(std::span<const Ray> rays,
                                        std::span<const std::uint32_t> samples,
                                        const PrimaryRays& image);

}  // namespace beambench::accel::beam

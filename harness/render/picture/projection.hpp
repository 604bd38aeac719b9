#pragma once
// Computes where points of the scene appear in an image.

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "accel/core/primary_rays.hpp"

namespace beambench::render {

/// The perspective of an image.
struct Projection {
  /// The image must outlive this object.
  explicit Projection(const accel::PrimaryRays& image) : rays(image), eye(image.eye()) {}

  /// Returns the depth along the view direction: 0 in the camera's plane, negative behind it.
  double depth(const glm::dvec3& point) const { return glm::dot(point - eye, rays.forward()); }
  /// Returns where a point of depth > 0 appears, in pixels; (0, 0) is the image's top left corner.
  glm::dvec2 place(const glm::dvec3& point) const {
    const glm::dvec3 offset = (point - eye) / depth(point) - rays.top_left();
    return {glm::dot(offset, rays.right()) / glm::dot(rays.right(), rays.right()),
            glm::dot(offset, rays.down()) / glm::dot(rays.down(), rays.down())};
  }
  /// Returns the direction from the camera through a place to depth 1: `t` along it is depth.
  glm::dvec3 direction(const glm::dvec2& place) const {
    return rays.top_left() + rays.right() * place.x + rays.down() * place.y;
  }
  /// Returns the width in pixels of a unit length at depth 1.
  double scale() const { return 1.0 / glm::length(rays.right()); }

  const accel::PrimaryRays& rays;
  glm::dvec3 eye;
};

}  // namespace beambench::render

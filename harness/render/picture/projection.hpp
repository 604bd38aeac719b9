#pragma once
// From points of a scene to the image plane: `PrimaryRays` backward.

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "accel/core/primary_rays.hpp"

namespace beambench::render {

/// The perspective of an image.
class Projection {
 public:
  explicit Projection(const accel::PrimaryRays& rays)
      : eye_(rays.eye()),
        forward_(rays.forward()),
        top_left_(rays.top_left()),
        right_(rays.right()),
        down_(rays.down()) {}

  const glm::dvec3& eye() const { return eye_; }
  /// Along the view direction: 0 in the eye's plane, negative behind it.
  double depth(const glm::dvec3& point) const { return glm::dot(point - eye_, forward_); }
  /// Where a point of depth > 0 appears, in pixels; (0, 0) is the image's top left corner.
  glm::dvec2 place(const glm::dvec3& point) const {
    const glm::dvec3 offset = (point - eye_) / depth(point) - top_left_;
    return {glm::dot(offset, right_) / glm::dot(right_, right_),
            glm::dot(offset, down_) / glm::dot(down_, down_)};
  }
  /// From the eye through a place to depth 1: `t` along it is depth.
  glm::dvec3 direction(const glm::dvec2& place) const {
    return top_left_ + right_ * place.x + down_ * place.y;
  }
  /// So many pixels wide is a unit length at depth 1.
  double scale() const { return 1.0 / glm::length(right_); }

 private:
  glm::dvec3 eye_;
  glm::dvec3 forward_;
  glm::dvec3 top_left_;
  glm::dvec3 right_;
  glm::dvec3 down_;
};

}  // namespace beambench::render

#pragma once
// What beams are traced for: a whole image, or what a mirror shows.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "accel/beam/beam.hpp"
#include "accel/beam/crossing.hpp"
#include "accel/core/hit_buffer.hpp"

namespace beambench::accel::beam {

/// The policy of an image: all of it, starting at the eye.
struct WholeImage {
  ImagePolygon part(const EyeView& view) const { return view.screen(); }
  /// Is a leaf skipped, whatever is in it?
  static constexpr bool passes(const CellGrid&, const Beam&) { return false; }
  /// Where a ray begins.
  static constexpr void begin(Ray&) {}
  /// The samples that need no tracing; empty where all need it.
  std::vector<std::uint8_t> finished(const HitBuffer&) const { return {}; }
};

/// The policy of a mirror, for the rays of its virtual eye: the samples that see the mirror,
/// starting at the mirror.
class BehindMirror {
 public:
  /// `point` and unit `normal` of the mirror's plane, the normal on the side of the real eye; rays
  /// begin `lift` above it. `part` covers the samples that see the mirror, `unwanted` has 1 for
  /// each that does not.
  BehindMirror(const glm::dvec3& point, const glm::dvec3& normal, double lift, ImagePolygon part,
               std::vector<std::uint8_t> unwanted)
      : point_(point),
        normal_(normal),
        lift_(lift),
        part_(std::move(part)),
        unwanted_(std::move(unwanted)) {}

  const ImagePolygon& part(const EyeView&) const { return part_; }

  /// Leaves on the same side of the mirror as the virtual eye are skipped.
  bool passes(const CellGrid& grid, const Beam& beam) const {
    double highest = -glm::dot(point_, normal_);
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t end = beam.corner[axis] + (normal_[axis] > 0.0 ? beam.size : 0);
      highest += normal_[axis] * grid.plane(axis, end);
    }
    return highest < 0.0;
  }

  void begin(Ray& ray) const {
    const double speed = glm::dot(normal_, glm::dvec3(ray.direction));
    const double distance = glm::dot(normal_, point_ - glm::dvec3(ray.origin)) + lift_;
    if (speed > 0.0 && distance > 0.0) ray.t_min = static_cast<float>(distance / speed);
  }

  std::vector<std::uint8_t> finished(const HitBuffer&) const { return unwanted_; }

 private:
  glm::dvec3 point_;
  glm::dvec3 normal_;
  double lift_;
  ImagePolygon part_;
  std::vector<std::uint8_t> unwanted_;
};

}  // namespace beambench::accel::beam

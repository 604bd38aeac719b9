#pragma once
// The primary rays of a camera at a resolution: the only place where pixels are converted to
// directions.

#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "accel/core/ray.hpp"
#include "scenes/camera.hpp"

namespace beambench::accel {

/// Returns the reflection of `incoming` in a mirror with this unit normal, without changing its
/// length.
inline glm::dvec3 mirrored(const glm::dvec3& incoming, const glm::dvec3& normal) {
  return incoming - 2.0 * glm::dot(incoming, normal) * normal;
}

/// Returns the positions of the samples of a pixel, as offsets in [0, 1]^2 from its top left
/// corner: 1 is the center; 5 are the four corners and the center (thesis, section 5.3.2; corners
/// are not shared between pixels); any other square number n x n is a regular grid of cell centers,
/// row by row. Throws InputError for other counts.
std::vector<glm::dvec2> sample_offsets(int samples);

/// The rays of an image, computed on demand. Directions satisfy forward . d = 1 before rounding, so
/// t is view depth. They are computed in double and each component is rounded once to float.
class PrimaryRays {
 public:
  /// Throws InputError when width or height is not in 1 ... 16384 or samples has no pattern.
  PrimaryRays(const scenes::Camera& camera, int width, int height, int samples);

  /// Returns the rays of the same samples behind a mirror, the plane through `point` with a unit
  /// `normal`. They start from the virtual eye, the mirror image of the eye (Heckbert and Hanrahan,
  /// "Beam tracing polygonal objects", SIGGRAPH 1984). A ray's t continues from where the real ray
  /// met the mirror. The eye is rounded to float.
  PrimaryRays mirrored(const glm::dvec3& point, const glm::dvec3& normal) const;

  /// Returns rays of the same samples in other directions, which are defined up to a common factor
  /// by the direction of the image's top left corner and the vectors from there across the image
  /// and down.
  PrimaryRays with_directions(const glm::dvec3& top_left, const glm::dvec3& across,
                              const glm::dvec3& all_down) const;

  /// Returns the rays through the corners of these pixels, one for each, as an image that is one
  /// pixel wider and one higher.
  PrimaryRays at_corners() const;

  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return static_cast<int>(offsets_.size()); }
  /// Returns width * height * samples.
  std::size_t count() const;

  /// Returns the ray of a sample; (0, 0) is the top left pixel.
  Ray ray(int x, int y, int sample) const {
    const glm::dvec2& offset = offsets_[static_cast<std::size_t>(sample)];
    return ray_at(x + offset.x, y + offset.y);
  }
  /// Calls `visit(index, ray)` for the samples of rows [begin, end), in the order of a HitBuffer of
  /// this size.
  template <class Visit>
  void for_each(int begin, int end, Visit visit) const {
    std::size_t index =
        static_cast<std::size_t>(begin) * static_cast<std::size_t>(width_) * offsets_.size();
    for (int y = begin; y < end; ++y) {
      for (int x = 0; x < width_; ++x) {
        for (const glm::dvec2& offset : offsets_) {
          visit(index++, ray_at(x + offset.x, y + offset.y));
        }
      }
    }
  }
  /// Returns the ray through a point of the image plane in pixels; (0, 0) is the top left corner.
  Ray ray_at(double px, double py) const {
    Ray ray;
    ray.origin = eye_;
    ray.direction = glm::vec3(top_left_ + right_ * px + down_ * py);
    return ray;
  }

  const glm::vec3& eye() const { return eye_; }
  /// Returns the view direction, with unit length.
  const glm::dvec3& forward() const { return forward_; }
  /// Returns the direction of the top left corner. Before rounding,
  /// direction(px, py) = top_left + right * px + down * py.
  const glm::dvec3& top_left() const { return top_left_; }
  const glm::dvec3& right() const { return right_; }
  const glm::dvec3& down() const { return down_; }
  /// Returns the vector from one side of the image to the other, the same at every resolution.
  const glm::dvec3& across() const { return across_; }
  const glm::dvec3& all_down() const { return all_down_; }
  const std::vector<glm::dvec2>& offsets() const { return offsets_; }

 private:
  int width_;
  int height_;
  std::vector<glm::dvec2> offsets_;
  glm::vec3 eye_;
  glm::dvec3 forward_;
  glm::dvec3 top_left_;
  glm::dvec3 right_;
  glm::dvec3 down_;
  glm::dvec3 across_;
  glm::dvec3 all_down_;
};

}  // namespace beambench::accel

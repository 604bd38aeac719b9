#pragma once
// Properties of the pencils of a batch.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "accel/core/primary_rays.hpp"
#include "accel/core/ray_batch.hpp"
#include "accel/core/tolerance.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/scene.hpp"

namespace beambench::tests {

/// Returns the distance at which a ray passes a point, in units of the float rounding of the
/// numbers involved.
inline double roundings_beside(const accel::Ray& ray, const glm::dvec3& apex, double extent) {
  const glm::dvec3 origin(ray.origin);
  const glm::dvec3 direction = glm::normalize(glm::dvec3(ray.direction));
  const glm::dvec3 away = apex - origin;
  const double beside = glm::length(away - glm::dot(away, direction) * direction);
  return beside / (0x1p-24 * (extent + glm::length(away)));
}

/// Counts the rays in pencils, and checks that they match their marks.
class CheckedPencils {
 public:
  /// `image` is the camera's image; `roundings` is the tolerance. Both must outlive this object.
  CheckedPencils(const scenes::Scene& scene, const accel::PrimaryRays& image, double roundings)
      : extent_(scene.bounds.largest_coordinate()),
        lift_(accel::mirror_lift(scene.bounds)),
        image_(&image),
        roundings_(roundings) {}

  /// Checks that pencils are in order and that their rays either run toward the apex and end there,
  /// or run away from it and match the view at their samples.
  void add(const accel::RayBatch& batch) {
    ASSERT_TRUE(batch.samples.empty() || batch.samples.size() == batch.rays.size());
    for (const std::uint32_t sample : batch.samples) ASSERT_LT(sample, image_->count());
    std::size_t next = 0;
    for (const accel::Pencil& pencil : batch.pencils) {
      ASSERT_GE(pencil.first, next);
      ASSERT_GE(pencil.count, 1U);
      next = pencil.first + pencil.count;
      ASSERT_LE(next, batch.rays.size());
      ASSERT_EQ(pencil.view == nullptr, pencil.toward);
      for (std::size_t i = pencil.first; i < next; ++i) {
        pencil.toward ? add_toward(batch.rays[i], pencil)
                      : add_away(batch.rays[i], pencil, batch.samples[i]);
      }
    }
  }

  std::size_t toward = 0;
  std::size_t away = 0;

 private:
  void add_line(const accel::Ray& ray, const accel::Pencil& pencil) {
    EXPECT_LE(roundings_beside(ray, pencil.apex, extent_), roundings_);
  }
  void add_toward(const accel::Ray& ray, const accel::Pencil& pencil) {
    add_line(ray, pencil);
    ++toward;
    const glm::dvec3 direction(ray.direction);
    const double before = (1.0 - ray.t_max) * glm::length(direction) /
                          accel::surface_lift(glm::dvec3(ray.origin), pencil.apex);
    EXPECT_GE(before, 0.9);
    EXPECT_LE(before, 1.1);
    EXPECT_LE(glm::length(glm::dvec3(ray.origin) + direction - pencil.apex),
              0x1p-24 * roundings_ * (extent_ + glm::length(direction)));
  }
  void add_away(const accel::Ray& ray, const accel::Pencil& pencil, std::uint32_t sample) {
    add_line(ray, pencil);
    ++away;
    const glm::dvec3 from_apex = glm::dvec3(ray.origin) - pencil.apex;
    EXPECT_GT(glm::dot(from_apex, glm::dvec3(ray.direction)), 0.0);
    EXPECT_EQ(ray.t_min, 0.0F);
    // Each mirror's lift does not move the view's eye.
    const accel::Ray seen = rays::ray_at(*pencil.view, sample);
    const glm::dvec3 line = glm::normalize(glm::dvec3(seen.direction));
    const glm::dvec3 offset = glm::dvec3(ray.origin) - glm::dvec3(seen.origin);
    EXPECT_LE(glm::length(offset - glm::dot(offset, line) * line),
              10.0 * lift_ + 0x1p-24 * roundings_ * (extent_ + glm::length(offset)));
    EXPECT_NEAR(glm::dot(line, glm::normalize(glm::dvec3(ray.direction))), 1.0, 1e-6);
  }

  double extent_;
  double lift_;
  const accel::PrimaryRays* image_;
  double roundings_;
};

}  // namespace beambench::tests

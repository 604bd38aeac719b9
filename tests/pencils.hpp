#pragma once
// What is true of the pencils of a batch.

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "accel/core/primary_rays.hpp"
#include "accel/core/ray_batch.hpp"

namespace beambench::testing {

/// By how much a ray passes beside a point, in units of what floats round of the numbers involved.
inline double roundings_beside(const accel::Ray& ray, const glm::dvec3& apex, double extent) {
  const glm::dvec3 origin(ray.origin);
  const glm::dvec3 direction = glm::normalize(glm::dvec3(ray.direction));
  const glm::dvec3 away = apex - origin;
  const double beside = glm::length(away - glm::dot(away, direction) * direction);
  return beside / (0x1p-24 * (extent + glm::length(away)));
}

/// The rays that are in pencils, and by how many roundings the worst of them passes its apex.
struct CheckedPencils {
  std::size_t toward = 0;
  std::size_t away = 0;
  double worst = 0.0;

  /// Pencils are in order; shadow rays end at the apex; mirror rays come from it, and their view
  /// shows the same at their samples. `extent` is the scene's largest coordinate; `image` that of
  /// the camera.
  void add(const accel::RayBatch& batch, double extent, const accel::PrimaryRays& image,
           double roundings) {
    ASSERT_TRUE(batch.samples.size() == batch.rays.size() || batch.pencils.empty());
    for (const std::uint32_t sample : batch.samples) ASSERT_LT(sample, image.count());
    std::size_t next = 0;
    for (const accel::Pencil& pencil : batch.pencils) {
      ASSERT_GE(pencil.first, next);
      ASSERT_GE(pencil.count, 1U);
      next = pencil.first + pencil.count;
      ASSERT_LE(next, batch.rays.size());
      (pencil.toward ? toward : away) += pencil.count;
      ASSERT_EQ(pencil.view == nullptr, pencil.toward);
      for (std::size_t i = pencil.first; i < next; ++i) {
        const accel::Ray& ray = batch.rays[i];
        const double beside = roundings_beside(ray, pencil.apex, extent);
        ASSERT_LE(beside, roundings) << "ray " << i;
        worst = std::max(worst, beside);
        const glm::dvec3 origin(ray.origin);
        const glm::dvec3 direction(ray.direction);
        if (pencil.toward) {
          ASSERT_EQ(ray.t_max, 1.0F);
          ASSERT_LE(glm::length(origin + direction - pencil.apex),
                    0x1p-24 * roundings * (extent + glm::length(direction)));
        } else {
          ASSERT_GT(glm::dot(origin - pencil.apex, direction), 0.0);
          ASSERT_EQ(ray.t_min, 0.0F);
        }
      }
    }
  }
};

}  // namespace beambench::testing

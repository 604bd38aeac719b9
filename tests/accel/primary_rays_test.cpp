// Primary rays: the positions of samples, and that t is view depth.

#include "accel/core/primary_rays.hpp"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "scenes/base/error.hpp"

namespace beambench::accel {
namespace {

scenes::Camera camera() {
  scenes::Camera camera;
  camera.from = {1, 2, 3};
  camera.at = {1, 2, -7};
  camera.up = {0, 1, 0};
  camera.angle = 90.0F;
  return camera;
}

TEST(PrimaryRays, CornersOfTheFrustum) {
  const PrimaryRays rays(camera(), 4, 2, 5);
  // 90 degrees: the image plane at depth 1 reaches from -1 to 1 on both axes, whatever the pixels.
  EXPECT_EQ(rays.ray(0, 0, 0).direction, glm::vec3(-1, 1, -1)) << "top left corner";
  EXPECT_EQ(rays.ray(3, 1, 3).direction, glm::vec3(1, -1, -1)) << "bottom right corner";
  EXPECT_EQ(rays.ray(0, 0, 4).direction, glm::vec3(-0.75F, 0.5F, -1)) << "center of pixel (0, 0)";
  EXPECT_EQ(rays.ray(2, 1, 1).origin, glm::vec3(1, 2, 3));
  EXPECT_EQ(rays.count(), 40U);
}

TEST(PrimaryRays, TIsViewDepth) {
  scenes::Camera skew = camera();
  skew.at = {4, 5, -1};
  skew.aspect = 1.6F;
  const PrimaryRays rays(skew, 33, 17, 4);
  for (int y = 0; y < 17; ++y) {
    for (int x = 0; x < 33; ++x) {
      EXPECT_NEAR(glm::dot(rays.forward(), glm::dvec3(rays.ray(x, y, 3).direction)), 1.0, 1e-6);
    }
  }
}

TEST(PrimaryRays, AResolutionOnlySamplesTheFrustum) {
  const PrimaryRays coarse(camera(), 3, 3, 1);
  const PrimaryRays fine(camera(), 9, 9, 1);
  EXPECT_EQ(coarse.ray(1, 0, 0).direction, fine.ray(4, 1, 0).direction);
}

TEST(SampleOffsets, Patterns) {
  EXPECT_EQ(sample_offsets(1).front(), glm::dvec2(0.5, 0.5));
  EXPECT_EQ(sample_offsets(5).size(), 5U);
  EXPECT_EQ(sample_offsets(9)[5], glm::dvec2(2.5 / 3.0, 0.5));
  EXPECT_THROW(sample_offsets(0), InputError);
  EXPECT_THROW(sample_offsets(3), InputError);
  EXPECT_THROW(sample_offsets(-4), InputError);
}

TEST(PrimaryRays, RefusesImpossibleResolutions) {
  EXPECT_THROW(PrimaryRays(camera(), 0, 10, 1), InputError);
  EXPECT_THROW(PrimaryRays(camera(), 10, 16385, 1), InputError);
}

TEST(RequireValid, RefusesBadNumbers) {
  const auto refused = [](const Ray& ray) { EXPECT_THROW(require_valid(ray), InputError); };
  const Ray good;
  EXPECT_NO_THROW(require_valid(good));
  Ray ray = good;
  ray.origin.y = std::numeric_limits<float>::quiet_NaN();
  refused(ray);
  ray = good;
  ray.direction.z = kInfinity;
  refused(ray);
  ray = good;
  ray.direction = glm::vec3(0.0F);
  refused(ray);
  ray.direction = glm::vec3(0.0F, 0.9e-30F, -0.9e-30F);
  refused(ray);
  ray.direction.x = -1e-30F;
  EXPECT_NO_THROW(require_valid(ray));
  ray = good;
  ray.t_min = -1.0F;
  refused(ray);
  ray = good;
  ray.t_max = std::numeric_limits<float>::quiet_NaN();
  refused(ray);
  ray = good;
  ray.origin.x = 2e9F;
  refused(ray);
}

}  // namespace
}  // namespace beambench::accel

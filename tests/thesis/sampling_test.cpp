// Properties of the methods of sampling an image.

#include "harness/thesis/sampling.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "harness/render/picture/image.hpp"
#include "harness/render/shading.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::thesis {
namespace {

TEST(ImageError, IsTheRootMeanSquareOfDisplayValues) {
  render::Image black(2, 2);
  render::Image picture = black;
  EXPECT_EQ(render::root_mean_square_error(picture, black), 0.0);
  picture.at(1, 0) = glm::vec3(1.0F);
  EXPECT_NEAR(render::root_mean_square_error(picture, black), 255.0 / 2.0, 1e-4);
  picture.at(1, 0) = glm::vec3(7.0F);
  EXPECT_NEAR(render::root_mean_square_error(picture, black), 255.0 / 2.0, 1e-4) << "clamped";
}

class Sampling : public ::testing::Test {
 protected:
  scenes::Scene scene_ = scenes::load_scene("delfines");
  accel::beam::BeamTracer tracer_{scene_, accel::beam::BeamOptions{}};
  accel::PrimaryRays rays_{scene_.cameras.front(), 60, 48, 25};
};

TEST_F(Sampling, AllSamplesYieldTheUniformPicture) {
  accel::HitBuffer hits(60, 48, 25);
  tracer_.closest_hits(rays_, hits, {});
  const render::Image uniform = render::shade(scene_, rays_, hits, render::Shading::kPreview);
  const render::Image object_space =
      sparse_image(scene_, rays_, accel::beam::trace_object_space(tracer_, rays_, {0.0, 0.0}));
  const render::Image image_space = sparse_image(
      scene_, rays_, trace_image_space(tracer_, scene_, scene_.cameras.front(), rays_, {0.0, 0.0}));
  EXPECT_LT(render::root_mean_square_error(object_space, uniform), 1e-3);
  EXPECT_LT(render::root_mean_square_error(image_space, uniform), 1e-3);
}

TEST_F(Sampling, ImageSpaceTakesMoreWhereThePictureChanges) {
  const accel::beam::SparseSamples some =
      trace_image_space(tracer_, scene_, scene_.cameras.front(), rays_, {0.05, 0.3});
  const std::vector<float> counts = samples_by_pixel(some);
  ASSERT_EQ(counts.size(), 60U * 48U);
  EXPECT_EQ(*std::ranges::min_element(counts), 1.0F);
  EXPECT_EQ(*std::ranges::max_element(counts), 25.0F);
  EXPECT_EQ(counts.front(), 1.0F) << "a corner of nothing but background";
}

TEST_F(Sampling, MoreRaysImproveThePictureByEveryMethod) {
  base::Progress progress(sampling_steps());
  const rays::ImageOfRays image{scene_.cameras.front(), {60, 48}, 1};
  const auto results = compare_sampling(tracer_, scene_, image, 1, progress);
  ASSERT_EQ(results.size(), sampling_steps() - 1);
  for (std::size_t i = 1; i < results.size(); ++i) {
    const SamplingResult& less = results[i - 1];
    const SamplingResult& more = results[i];
    EXPECT_TRUE(std::isfinite(more.error));
    EXPECT_GT(more.trace_ms, 0.0);
    if (less.method != more.method) continue;
    EXPECT_GT(more.rays, less.rays) << more.method << ' ' << more.setting;
    EXPECT_LT(more.error, less.error) << more.method << ' ' << more.setting;
  }
}

}  // namespace
}  // namespace beambench::thesis

// Pictures in waves: structures receive batches, and results do not depend on how rays are divided.

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "accel/core/forwarding_accelerator.hpp"
#include "accel/core/tolerance.hpp"
#include "harness/rays/normal.hpp"
#include "harness/render/places.hpp"
#include "harness/render/shading.hpp"
#include "scenes/catalogue.hpp"
#include "tests/drawn.hpp"

namespace beambench::render {
namespace {

/// Forwards queries and counts them.
class CountedCalls : public accel::ForwardingAccelerator {
 public:
  using ForwardingAccelerator::ForwardingAccelerator;

  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override {
    note(rays);
    ForwardingAccelerator::closest_hits(rays, hits, context);
  }
  void any_hits(const accel::RaySource& rays, std::span<std::uint8_t> hits,
                const accel::QueryContext& context) const override {
    note(rays);
    ForwardingAccelerator::any_hits(rays, hits, context);
  }

  mutable std::size_t single = 0;
  mutable std::size_t batches = 0;
  mutable std::size_t largest = 0;

 private:
  void note(const accel::RaySource& rays) const {
    if (rays.ray() != nullptr) ++single;
    if (rays.batch() == nullptr) return;
    EXPECT_GT(rays.size(), 0U) << "a query has no rays";
    ++batches;
    largest = std::max(largest, rays.size());
  }
};

/// The camera rays of an image, and their hits, as a list.
struct Listed {
  Listed(const accel::Accelerator& structure, accel::PrimaryRays rays_of)
      : image(std::move(rays_of)) {
    image.for_each(0, image.height(), [&](std::size_t sample, const accel::Ray& ray) {
      rays.push_back(ray);
      samples.push_back(static_cast<std::uint32_t>(sample));
      hits.push_back(structure.closest_hit(ray, nullptr));
    });
  }
  CameraRays some(std::size_t first, std::size_t count) const {
    return {&image, std::span(rays).subspan(first, count), std::span(samples).subspan(first, count),
            std::span(hits).subspan(first, count)};
  }
  accel::PrimaryRays image;
  std::vector<accel::Ray> rays;
  std::vector<std::uint32_t> samples;
  std::vector<std::optional<accel::Hit>> hits;
};

std::vector<glm::dvec3> light(const Whitted& tracer, const Listed& camera, std::size_t at_once,
                              RayCensus& census) {
  std::vector<glm::dvec3> colors(camera.rays.size());
  Whitted::Progress progress = tracer.begin();
  for (std::size_t first = 0; first < colors.size(); first += at_once) {
    const std::size_t count = std::min(at_once, colors.size() - first);
    tracer.trace_light(camera.some(first, count), std::span(colors).subspan(first, count),
                       progress);
  }
  census = progress.census;
  return colors;
}

TEST(Waves, TraceOnlyInBatches) {
  const scenes::Scene scene = scene_of_all_surfaces(2);
  const auto structure = built(scene, "sah-bvh");
  const CountedCalls counted(*structure);
  const accel::PrimaryRays rays(scene.cameras.front(), 100, 80, 1);
  accel::HitBuffer hits(100, 80, 1);
  structure->closest_hits(rays, hits, {});
  Image image(100, 80);
  const RayCensus census = draw_in_order(Whitted(scene, counted, {}), rays, hits, image);
  EXPECT_EQ(counted.single, 0U);
  EXPECT_GT(census.shadow + census.reflected + census.refracted, 50 * counted.batches);
}

TEST(Waves, ReturnTheSameBitsForAnyDivisionOfRays) {
  for (const ShadowMethod shadows : {ShadowMethod::kRays, ShadowMethod::kCache}) {
    const scenes::Scene scene = scene_of_all_surfaces(4);  // with glass: two rays from one place
    const auto structure = built(scene, "samet");
    const Listed camera(*structure, {scene.cameras.front(), 90, 70, 1});
    const Whitted tracer(scene, *structure, {.max_depth = 7, .shadows = shadows});
    RayCensus expected, found;
    const auto alone = light(tracer, camera, 1, expected);
    EXPECT_GT(expected.refracted, 100U);
    for (const std::size_t at_once : {std::size_t{7}, std::size_t{1000}, alone.size()}) {
      EXPECT_EQ(light(tracer, camera, at_once, found), alone) << at_once;
      EXPECT_EQ(found, expected) << at_once;
    }
  }
}

TEST(Waves, GiveTheSamePictureForAnyBatch) {
  for (const char* spec : {"sah-bvh", "beam"}) {
    for (const std::uint64_t seed : {2U, 4U}) {  // with mirrors and glass
      const scenes::Scene scene = scene_of_all_surfaces(seed);
      const auto structure = built(scene, spec);
      const accel::PrimaryRays rays(scene.cameras.front(), 90, 70, 4);
      accel::HitBuffer hits(90, 70, 4);
      structure->closest_hits(rays, hits, {});
      const auto drawn = [&](int batch, Image& image) {
        const CountedCalls counted(*structure);
        const Whitted tracer(scene, counted, {.batch = batch});
        const RayCensus census = draw_in_order(tracer, rays, hits, image);
        EXPECT_LE(counted.largest, static_cast<std::size_t>(batch));
        return census;
      };
      Image expected(90, 70);
      const RayCensus census = drawn(rays::kMaxPictureBatch, expected);  // more than the image
      EXPECT_GT(census.reflected, 100U);
      EXPECT_GT(census.refracted, 100U);
      for (const int batch : {7, 64, 1000, 4096}) {  // 64: the smallest square
        SCOPED_TRACE(batch);
        Image image(90, 70);
        EXPECT_EQ(drawn(batch, image), census);
        expect_same_bits(image, expected);
      }
    }
  }
}

// No batch has more rays than requested, however many are spawned.
TEST(Waves, KeepBatchesSmall) {
  scenes::SceneBuilder builder = with_light({0.0, 0.0, 50.0});
  builder.set_surface({.specular = 0.9F, .transmittance = 0.9F, .refraction_index = 1.01F});
  for (int i = 0; i < 12; ++i) add_floor(builder, -static_cast<double>(i));
  const scenes::Scene scene = std::move(builder).build();
  const auto structure = built(scene, "sah-bvh");
  const CountedCalls counted(*structure);
  accel::Ray ray;
  ray.origin = {0.0F, 0.0F, 5.0F};
  ray.direction = {0.1F, 0.0F, -1.0F};
  scenes::Camera camera;
  camera.from = ray.origin;
  camera.at = ray.origin + ray.direction;
  camera.up = {0.0F, 1.0F, 0.0F};
  const accel::PrimaryRays image(camera, 1, 1, 1);
  const std::vector<accel::Ray> rays(5000, ray);
  const std::vector<std::uint32_t> samples(5000, 0);
  const std::vector<std::optional<accel::Hit>> hits(5000, structure->closest_hit(ray, nullptr));
  std::vector<glm::dvec3> colors(5000);
  const Whitted tracer(scene, counted, {.max_depth = 9, .batch = 1000});
  Whitted::Progress progress = tracer.begin();
  tracer.trace_light({&image, rays, samples, hits}, colors, progress);
  EXPECT_GT(progress.census.refracted, 50'000U);
  EXPECT_EQ(counted.largest, 1000U);
  for (const glm::dvec3& color : colors) ASSERT_EQ(color, colors.front());
}

// On every instruction set, SIMD code returns the same bits as glm.
TEST(Places, MatchSingleRays) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const PlaceKernels& kernels = place_kernels(target);
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const scenes::Scene scene = scene_of_all_surfaces(seed);
      const auto structure = built(scene, "sah-bvh");
      const Listed camera(*structure, {scene.cameras.front(), 37, 29, 1});
      const rays::NormalTable table(scene);
      std::vector<std::size_t> hit;
      for (std::size_t i = 0; i < camera.hits.size(); ++i) {
        if (camera.hits[i]) hit.push_back(i);
      }
      Places places(hit.size());
      for (std::size_t k = 0; k < hit.size(); ++k) {
        const accel::Ray& ray = camera.rays[hit[k]];
        const accel::Hit& found = *camera.hits[hit[k]];
        const glm::dvec3 direction(ray.direction);
        const glm::dvec3 point = glm::dvec3(ray.origin) + double{found.t} * direction;
        const auto normals = rays::surface_normals(scene, found.primitive, point, table);
        places.point.set(k, point);
        places.lift[k] = accel::surface_lift(glm::dvec3(ray.origin), point);
        places.incoming.set(k, direction);
        places.geometric.set(k, normals.geometric);
        places.shading.set(k, normals.shading);
      }
      kernels.complete(places);
      const glm::dvec3 position(scene.lights.front().position);
      LightAngles angles(hit.size());
      kernels.find_angles(places, position, angles);
      for (std::size_t k = 0; k < hit.size(); ++k) {
        const accel::Ray& ray = camera.rays[hit[k]];
        const accel::Hit& found = *camera.hits[hit[k]];
        const glm::dvec3 incoming = glm::normalize(glm::dvec3(ray.direction));
        const glm::dvec3 geometric = rays::geometric_normal(scene, ray, found);
        const glm::dvec3 shading = rays::shading_normal(scene, ray, found);
        const glm::dvec3 beside = places.point[k] + geometric * places.lift[k];
        const glm::dvec3 offset = position - beside;
        const glm::dvec3 to_light = glm::normalize(offset);
        ASSERT_EQ(places.incoming[k], incoming);
        ASSERT_EQ(places.geometric[k], geometric);
        ASSERT_EQ(places.shading[k], shading);
        ASSERT_EQ(places.beside[k], beside);
        ASSERT_EQ(angles.cosine[k], glm::dot(to_light, shading));
        ASSERT_EQ(angles.gleam[k], glm::dot(accel::mirrored(-to_light, shading), -incoming));
        ASSERT_EQ(angles.is_before[k] == 1.0,
                  glm::dot(offset, geometric) > 0.0 && glm::dot(offset, shading) > 0.0);
      }
    }
  }
}

}  // namespace
}  // namespace beambench::render

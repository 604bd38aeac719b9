// The whole ray tracer: hand-computed colours, shadows that all ways agree on, published counts.

#include <cmath>
#include <memory>

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "accel/registry.hpp"
#include "harness/picture/srgb.hpp"
#include "harness/shade/noise.hpp"
#include "harness/shade/refracted.hpp"
#include "harness/shade/whitted_picture.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/error.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/random_scene.hpp"

namespace beambench {
namespace {

using glm::dvec3;

constexpr double kAmbient = 0.06;

std::unique_ptr<Accelerator> built(const Scene& scene, const std::string& spec) {
  return registry().choose(parse_spec(spec)).build(scene);
}

/// What an eye sees along one ray.
dvec3 seen(const Scene& scene, const dvec3& origin, const dvec3& direction,
           const WhittedOptions& options = {}) {
  const auto structure = built(scene, "exhaustive");
  const Whitted tracer(scene, *structure, options);
  Whitted::Progress progress = tracer.begin();
  Ray ray;
  ray.origin = glm::vec3(origin);
  ray.direction = glm::vec3(direction);
  return tracer.eye_color(ray, structure->closest_hit(ray), progress);
}

void expect_color(const dvec3& color, const dvec3& expected) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(color[i], expected[i], 1e-5) << "component " << i;
}

dvec3 linear(double r, double g, double b) {
  return dvec3(linear_from_srgb(
      glm::vec3(static_cast<float>(r), static_cast<float>(g), static_cast<float>(b))));
}

/// A square of the plane z = height, 40 wide.
void add_floor(SceneBuilder& builder, double height) {
  const std::array<dvec3, 4> corners{dvec3(-20, -20, height), dvec3(20, -20, height),
                                     dvec3(20, 20, height), dvec3(-20, 20, height)};
  builder.add_polygon(corners);
}

SceneBuilder with_light(const dvec3& position, const dvec3& color = dvec3(1.0)) {
  SceneBuilder builder("by hand");
  builder.set_background({0.2, 0.4, 0.8});
  builder.add_light(position, color);
  return builder;
}

TEST(Whitted, AMatteFloorHasTheCosineOfTheLight) {
  SceneBuilder builder = with_light({3.0, 0.0, 4.0});
  builder.set_surface({.color = {0.5F, 0.25F, 1.0F}, .diffuse = 0.8F});
  add_floor(builder, 0.0);
  const Scene scene = std::move(builder).build();
  // The light is 3 aside and 4 above: the cosine is 4/5.
  expect_color(seen(scene, {0, 0, 5}, {0, 0, -1}), 0.8 * linear(0.5, 0.25, 1.0) * (kAmbient + 0.8));
}

TEST(Whitted, LightsWithoutAColourShareOneOverTheRootOfTheirNumber) {
  SceneBuilder builder = with_light({0.0, 0.0, 4.0});
  builder.add_light({0.0, 0.0, 9.0});
  builder.add_light({0.0, 0.0, 6.0}, {0.1, 0.2, 0.3});  // said, so taken as it is
  builder.set_surface({.color = {1, 1, 1}, .diffuse = 1.0F});
  add_floor(builder, 0.0);
  const Scene scene = std::move(builder).build();
  expect_color(seen(scene, {1, 0, 5}, {-1, 0, -5}),
               dvec3(kAmbient + 2.0 / std::sqrt(3.0)) + dvec3(0.1, 0.2, 0.3));
}

TEST(Whitted, WhatIsHiddenFromTheLightHasAmbientLightOnly) {
  SceneBuilder builder = with_light({0.0, 0.0, 8.0});
  builder.set_surface({.color = {1, 1, 1}, .diffuse = 1.0F});
  add_floor(builder, 0.0);
  builder.add_sphere({0, 0, 4}, 1.0);
  const Scene scene = std::move(builder).build();
  expect_color(seen(scene, {0, 6, 3}, {0, -2, -1}), dvec3(kAmbient));
}

TEST(Whitted, GlassLetsItsTransmittanceOfTheLightThroughTwice) {
  SceneBuilder builder = with_light({0.0, 0.0, 8.0});
  builder.set_surface({.color = {1, 1, 1}, .diffuse = 1.0F});
  add_floor(builder, 0.0);
  builder.set_surface({.diffuse = 0.0F, .transmittance = 0.6F, .refraction_index = 1.0F});
  builder.add_sphere({0, 0, 4}, 1.0);
  const Scene scene = std::move(builder).build();
  for (const ShadowMethod method :
       {ShadowMethod::kRays, ShadowMethod::kCache, ShadowMethod::kLightBuffer}) {
    WhittedOptions options;
    options.shadows = method;
    expect_color(seen(scene, {0, 6, 3}, {0, -2, -1}, options), dvec3(kAmbient + 0.6 * 0.6));
  }
}

TEST(Whitted, AMirrorShowsWhatItSees) {
  SceneBuilder builder = with_light({0.0, 0.0, -5.0});  // behind the mirror
  builder.set_surface({.color = {1, 1, 1}, .diffuse = 0.0F, .specular = 0.9F});
  add_floor(builder, 0.0);
  const Scene scene = std::move(builder).build();
  expect_color(seen(scene, {0, 0, 5}, {1, 0, -1}), 0.9 * linear(0.2, 0.4, 0.8));
  expect_color(seen(scene, {0, 0, 5}, {1, 0, -1}, {.max_depth = 1}), dvec3(0.0));
}

TEST(Whitted, TwoMirrorsEndAtTheDepth) {
  SceneBuilder builder = with_light({0.0, 0.0, 50.0});
  builder.set_surface({.color = {1, 1, 1}, .diffuse = 0.0F, .specular = 0.5F});
  add_floor(builder, 0.0);
  add_floor(builder, 2.0);
  const Scene scene = std::move(builder).build();
  const auto structure = built(scene, "exhaustive");
  for (int depth = 1; depth <= 6; ++depth) {
    const Whitted tracer(scene, *structure, {.max_depth = depth});
    Whitted::Progress progress = tracer.begin();
    Ray ray;
    ray.origin = {0, 0, 1};
    ray.direction = {0.1F, 0, -1};
    tracer.eye_color(ray, structure->closest_hit(ray), progress);
    EXPECT_EQ(progress.census.reflected, static_cast<std::uint64_t>(depth - 1));
  }
  // The third ray is a quarter of the pixel, the fourth an eighth.
  const Whitted tracer(scene, *structure, {.max_depth = 6, .least_weight = 0.2});
  Whitted::Progress progress = tracer.begin();
  Ray ray;
  ray.origin = {0, 0, 1};
  ray.direction = {0.1F, 0, -1};
  tracer.eye_color(ray, structure->closest_hit(ray), progress);
  EXPECT_EQ(progress.census.reflected, 2U);
  EXPECT_EQ(progress.census.too_faint, 1U);
}

TEST(Whitted, AGlassBallOfIndexOneIsNotThere) {
  SceneBuilder builder = with_light({0.0, 0.0, -50.0});
  builder.set_surface({.diffuse = 0.0F, .transmittance = 1.0F, .refraction_index = 1.0F});
  builder.add_sphere({0, 0, 0}, 1.0);
  const Scene scene = std::move(builder).build();
  expect_color(seen(scene, {0.3, 0.2, 5}, {0, 0, -1}), linear(0.2, 0.4, 0.8));
}

TEST(Refracted, FollowsSnell) {
  const dvec3 normal(0, 0, 1);
  for (const double degrees : {0.0, 10.0, 35.0, 60.0, 89.0}) {
    const double sine = std::sin(degrees * 3.14159265358979 / 180.0);
    const dvec3 incoming(sine, 0.0, -std::sqrt(1.0 - sine * sine));
    const auto behind = refracted(incoming, normal, 1.0 / 1.5);
    ASSERT_TRUE(behind.has_value());
    EXPECT_NEAR(behind->x, sine / 1.5, 1e-12);
    EXPECT_NEAR(glm::length(*behind), 1.0, 1e-12);
    EXPECT_LT(behind->z, 0.0);
    // And the same way back.
    const auto before = refracted(-*behind, -normal, 1.5);
    ASSERT_TRUE(before.has_value());
    EXPECT_NEAR(glm::length(*before + incoming), 0.0, 1e-9);
  }
  // From glass, past the critical angle of 41.8 degrees, nothing comes out.
  EXPECT_FALSE(refracted(glm::normalize(dvec3(0.7, 0.0, -0.7)), normal, 1.5).has_value());
}

/// A random scene with lights, mirrors and glass.
Scene scene_of_all_surfaces(std::uint64_t seed) {
  Scene scene = testing::random_scene(seed, 60);
  Random random(seed);
  scene.lights = {{{3.0F, 2.0F, 4.0F}, glm::vec3(1.0F)}, {{0.1F, 0.2F, 0.3F}, glm::vec3(0.5F)}};
  scene.surfaces = {{.color = {0.9F, 0.5F, 0.2F}, .diffuse = 0.8F},
                    {.diffuse = 0.3F, .specular = 0.6F, .shine = 20.0F},
                    {.diffuse = 0.2F, .transmittance = 0.7F, .refraction_index = 1.4F}};
  for (Primitive& primitive : scene.primitives) {
    primitive.surface = static_cast<std::uint32_t>(random.below(seed % 2 == 0 ? 3 : 2));
  }
  return scene;
}

WhittedPicture picture(const Scene& scene, const std::string& spec, const WhittedOptions& options) {
  const auto structure = built(scene, spec);
  const PrimaryRays rays(scene.cameras.front(), 40, 30, 1);
  HitBuffer hits(40, 30, 1);
  structure->trace(rays, hits);
  return whitted_picture(Whitted(scene, *structure, options), eye_rays(rays), hits);
}

void expect_same_bits(const Image& a, const Image& b) {
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) ASSERT_EQ(a.at(x, y), b.at(x, y)) << x << ", " << y;
  }
}

TEST(Whitted, ClassicStructuresGiveTheSameBits) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = scene_of_all_surfaces(seed);
    const WhittedPicture expected = picture(scene, "exhaustive", {});
    for (const char* spec :
         {"samet", "samet-net", "voxel-grid", "goldsmith-salmon", "sah-bvh", "beam"}) {
      SCOPED_TRACE(spec);
      const WhittedPicture found = picture(scene, spec, {});
      expect_same_bits(found.image, expected.image);
      EXPECT_EQ(found.census, expected.census);
    }
  }
}

TEST(Whitted, AllWaysOfFindingShadowsGiveTheSameBits) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = scene_of_all_surfaces(seed);
    const WhittedPicture expected = picture(scene, "sah-bvh", {});
    for (const ShadowMethod method : {ShadowMethod::kCache, ShadowMethod::kLightBuffer}) {
      const WhittedPicture found = picture(scene, "sah-bvh", {.shadows = method});
      expect_same_bits(found.image, expected.image);
      EXPECT_EQ(found.census.shadow, expected.census.shadow);
      EXPECT_EQ(found.census.shadow_hidden, expected.census.shadow_hidden);
      EXPECT_LT(found.census.shadow_queries, expected.census.shadow_queries);
    }
  }
}

TEST(LightBuffer, AnswersAsASearchOfAllPrimitives) {
  std::size_t hidden = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    const Scene scene = testing::random_scene(seed, 50);
    Random random(seed);
    const auto structure = built(scene, "exhaustive");
    const glm::vec3 light = testing::random_ray(scene, random).origin;
    const LightBuffer buffer(scene, light, 1 + static_cast<int>(random.below(40)));
    for (int i = 0; i < 300; ++i) {
      Ray ray;
      ray.origin = testing::random_ray(scene, random).origin;
      ray.direction = light - ray.origin;
      ray.t_max = 1.0F;
      if (ray.direction == glm::vec3(0.0F)) continue;
      std::uint64_t tests = 0;
      const bool expected = structure->any_hit(ray);
      hidden += expected ? 1 : 0;
      ASSERT_EQ(buffer.ask(ray, tests),
                expected ? LightBuffer::Answer::kHidden : LightBuffer::Answer::kFree)
          << "ray " << i;
    }
  }
  EXPECT_GT(hidden, 1000U);
}

TEST(LightBuffer, TestsFewerPrimitivesThanThereAre) {
  const Scene scene = load_scene("balls:n=3");
  const WhittedPicture found = picture(scene, "sah-bvh", {.shadows = ShadowMethod::kLightBuffer});
  EXPECT_EQ(found.census.shadow_listed, found.census.shadow);
  EXPECT_LT(found.census.shadow_tests, 20 * found.census.shadow);
}

TEST(Whitted, PictureAndCensusDoNotDependOnTheThreads) {
  const Scene scene = load_scene("balls:n=2");
  const WhittedOptions options{.shadows = ShadowMethod::kCache};
  const auto on = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return picture(scene, "samet", options);
  };
  const WhittedPicture one = on(1);
  const WhittedPicture many = on(4);
  expect_same_bits(one.image, many.image);
  EXPECT_EQ(one.census, many.census);
}

RayCensus spd_census(const std::string& name) {
  const Scene scene = load_scene(name);
  const auto structure = built(scene, "sah-bvh");
  const EyeRays rays = corner_rays(scene.cameras.front());
  HitBuffer hits(rays.width, rays.height, 1);
  for (int y = 0; y < rays.height; ++y) {
    for (int x = 0; x < rays.width; ++x) {
      hits.set(hits.index(x, y, 0), structure->closest_hit(rays.ray(x, y, 0)));
    }
  }
  return whitted_picture(Whitted(scene, *structure, {}), rays, hits).census;
}

void expect_within(std::uint64_t found, double published, double share) {
  EXPECT_NEAR(static_cast<double>(found), published, share * published);
}

TEST(Census, OfTetraIsHaines) {
  const RayCensus census = spd_census("tetra:n=6");
  EXPECT_EQ(census.eye, 263'169U);
  EXPECT_EQ(census.reflected, 0U);
  EXPECT_EQ(census.refracted, 0U);
  expect_within(census.eye_hits, 49'788, 0.02);
  expect_within(census.shadow, 46'112, 0.02);
}

TEST(Census, OfTeapotIsHaines) {
  const RayCensus census = spd_census("teapot:n=12");
  EXPECT_EQ(census.eye, 263'169U);
  expect_within(census.eye_hits, 161'120, 0.05);
  expect_within(census.reflected, 225'248, 0.05);
  expect_within(census.shadow, 407'656, 0.05);
}

TEST(Noise, IsNothingAtTheLatticeAndStaysInItsRange) {
  Random random(7);
  double least = 0.0;
  double most = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    const dvec3 point(random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50));
    const double noise = gradient_noise(point);
    least = std::min(least, noise);
    most = std::max(most, noise);
    EXPECT_EQ(gradient_noise(glm::floor(point)), 0.0);
    // Smooth: a step of 1e-6 changes it by about as little.
    EXPECT_NEAR(gradient_noise(point + dvec3(1e-6)), noise, 1e-5);
  }
  EXPECT_LT(most, 1.1);
  EXPECT_GT(least, -1.1);
  EXPECT_GT(most, 0.6);
  EXPECT_LT(least, -0.6);
}

TEST(Texture, VariesAboutTheColourOfItsSurface) {
  SceneBuilder builder("ball");
  builder.add_sphere({0, 0, 0}, 10.0);
  const Scene scene = std::move(builder).build();
  const TextureSpace textures(scene);
  for (int finish = 0; finish <= static_cast<int>(Finish::kWhiteMarble); ++finish) {
    SCOPED_TRACE(finish);
    const Surface surface = finished_surface(static_cast<Finish>(finish));
    const std::string_view word = finish_word(surface.finish);
    const bool texture = word.starts_with("tex") || word == "surfgranite";
    Random random(3);
    dvec3 sum(0.0);
    double spread = 0.0;
    constexpr int kPoints = 4000;
    for (int i = 0; i < kPoints; ++i) {
      const dvec3 point(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
      const dvec3 color = textures.color_at(surface, point);
      sum += color;
      spread += glm::length(color - dvec3(surface.color));
    }
    EXPECT_LT(glm::length(sum / double{kPoints} - dvec3(surface.color)), 0.3);
    if (texture) {
      EXPECT_GT(spread / kPoints, 0.02);
    } else {
      EXPECT_EQ(spread, 0.0);
    }
  }
}

/// A picture of 64 x 64 pixels, as a PNG keeps it.
OIIO::ImageBuf as_png(const Image& image) {
  OIIO::ImageBuf buffer(OIIO::ImageSpec(image.width(), image.height(), 3, OIIO::TypeDesc::UINT8));
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const glm::vec3 encoded = srgb_from_linear(image.at(x, y));
      const std::array<float, 3> pixel{encoded.x, encoded.y, encoded.z};
      buffer.setpixel(x, y, pixel);
    }
  }
  return buffer;
}

TEST(Whitted, GoldenPictures) {
  for (const std::string name : {"balls:n=2", "mount:n=3", "teapot:n=3"}) {
    SCOPED_TRACE(name);
    const Scene scene = load_scene(name);
    const auto structure = built(scene, "sah-bvh");
    const PrimaryRays rays(scene.cameras.front(), 64, 64, 1);
    HitBuffer hits(64, 64, 1);
    structure->trace(rays, hits);
    const OIIO::ImageBuf found =
        as_png(whitted_picture(Whitted(scene, *structure, {}), eye_rays(rays), hits).image);
    const std::string file =
        BEAMBENCH_TEST_FILES "/golden/whitted/" + name.substr(0, name.find(':')) + ".png";
    const OIIO::ImageBuf golden(file);
    ASSERT_TRUE(golden.initialized()) << golden.geterror();
    // Another libm may round pow another way, and a ray along an edge may go the other way.
    const auto difference = OIIO::ImageBufAlgo::compare(found, golden, 3.0F / 255.0F, 0.0F);
    EXPECT_LE(difference.nfail, 40U) << "of 64 x 64 pixels";
    EXPECT_LT(difference.meanerror, 0.002);
  }
}

TEST(ShadowMethods, AreNamed) {
  for (const std::string_view name : shadow_method_names()) {
    EXPECT_EQ(shadow_method_names()[static_cast<std::size_t>(parse_shadow_method(name))], name);
  }
  EXPECT_THROW(parse_shadow_method("guess"), InputError);
}

}  // namespace
}  // namespace beambench

// The whole ray tracer: hand-computed colors, and the same bits from all classic structures and any
// number of threads.

#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "harness/render/shading.hpp"
#include "scenes/catalogue.hpp"
#include "tests/drawn.hpp"

namespace beambench::render {
namespace {

using glm::dvec3;

constexpr double kAmbient = 0.06;

TEST(Whitted, AMatteFloorHasTheCosineOfTheLight) {
  scenes::SceneBuilder builder = with_light({3.0, 0.0, 4.0});
  builder.set_surface({.color = {0.5F, 0.25F, 1.0F}, .diffuse = 0.8F});
  add_floor(builder, 0.0);
  const scenes::Scene scene = std::move(builder).build();
  // The light is 3 to the side and 4 above: the cosine is 4/5.
  expect_color(seen(scene, {0, 0, 5}, {0, 0, -1}), 0.8 * linear(0.5, 0.25, 1.0) * (kAmbient + 0.8));
}

TEST(Whitted, LightsWithoutAColorShareOneOverTheRootOfTheirNumber) {
  scenes::SceneBuilder builder = with_light({0.0, 0.0, 4.0});
  builder.add_light({0.0, 0.0, 9.0});
  builder.add_light({0.0, 0.0, 6.0}, {0.1, 0.2, 0.3});  // an explicit color is used as it is
  builder.set_surface({.color = {1, 1, 1}, .diffuse = 1.0F});
  add_floor(builder, 0.0);
  const scenes::Scene scene = std::move(builder).build();
  expect_color(seen(scene, {1, 0, 5}, {-1, 0, -5}),
               dvec3(kAmbient + 2.0 / std::sqrt(3.0)) + dvec3(0.1, 0.2, 0.3));
}

TEST(Whitted, SurfacesHiddenFromTheLightHaveOnlyAmbientLight) {
  scenes::SceneBuilder builder = with_light({0.0, 0.0, 8.0});
  builder.set_surface({.color = {1, 1, 1}, .diffuse = 1.0F});
  add_floor(builder, 0.0);
  builder.add_sphere({0, 0, 4}, 1.0);
  const scenes::Scene scene = std::move(builder).build();
  expect_color(seen(scene, {0, 6, 3}, {0, -2, -1}), dvec3(kAmbient));
}

TEST(Whitted, GlassLetsItsTransmittanceOfTheLightThroughTwice) {
  scenes::SceneBuilder builder = with_light({0.0, 0.0, 8.0});
  builder.set_surface({.color = {1, 1, 1}, .diffuse = 1.0F});
  add_floor(builder, 0.0);
  builder.set_surface({.diffuse = 0.0F, .transmittance = 0.6F, .refraction_index = 1.0F});
  builder.add_sphere({0, 0, 4}, 1.0);
  const scenes::Scene scene = std::move(builder).build();
  for (const ShadowMethod method :
       {ShadowMethod::kRays, ShadowMethod::kCache, ShadowMethod::kLightBuffer}) {
    WhittedOptions options;
    options.shadows = method;
    expect_color(seen(scene, {0, 6, 3}, {0, -2, -1}, options), dvec3(kAmbient + 0.6 * 0.6));
  }
}

TEST(Whitted, AMirrorShowsItsSurroundings) {
  scenes::SceneBuilder builder = with_light({0.0, 0.0, -5.0});  // behind the mirror
  builder.set_surface({.color = {1, 1, 1}, .diffuse = 0.0F, .specular = 0.9F});
  add_floor(builder, 0.0);
  const scenes::Scene scene = std::move(builder).build();
  expect_color(seen(scene, {0, 0, 5}, {1, 0, -1}), 0.9 * linear(0.2, 0.4, 0.8));
  expect_color(seen(scene, {0, 0, 5}, {1, 0, -1}, {.max_depth = 1}), dvec3(0.0));
}

TEST(Whitted, TwoMirrorsEndAtTheDepth) {
  scenes::SceneBuilder builder = with_light({0.0, 0.0, 50.0});
  builder.set_surface({.color = {1, 1, 1}, .diffuse = 0.0F, .specular = 0.5F});
  add_floor(builder, 0.0);
  add_floor(builder, 2.0);
  const scenes::Scene scene = std::move(builder).build();
  const auto structure = built(scene, "exhaustive");
  for (int depth = 1; depth <= 6; ++depth) {
    const Whitted tracer(scene, *structure, {.max_depth = depth});
    Whitted::Progress progress = tracer.begin();
    accel::Ray ray;
    ray.origin = {0, 0, 1};
    ray.direction = {0.1F, 0, -1};
    light_along(tracer, ray, structure->closest_hit(ray, nullptr), progress);
    EXPECT_EQ(progress.census.reflected, static_cast<std::uint64_t>(depth - 1));
  }
  // The third ray contributes a quarter of the pixel, the fourth an eighth.
  const Whitted tracer(scene, *structure, {.max_depth = 6, .min_weight = 0.2});
  Whitted::Progress progress = tracer.begin();
  accel::Ray ray;
  ray.origin = {0, 0, 1};
  ray.direction = {0.1F, 0, -1};
  light_along(tracer, ray, structure->closest_hit(ray, nullptr), progress);
  EXPECT_EQ(progress.census.reflected, 2U);
  EXPECT_EQ(progress.census.too_faint, 1U);
}

TEST(Whitted, AGlassBallOfIndexOneIsInvisible) {
  scenes::SceneBuilder builder = with_light({0.0, 0.0, -50.0});
  builder.set_surface({.diffuse = 0.0F, .transmittance = 1.0F, .refraction_index = 1.0F});
  builder.add_sphere({0, 0, 0}, 1.0);
  const scenes::Scene scene = std::move(builder).build();
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
    // And reversed along the same path.
    const auto before = refracted(-*behind, -normal, 1.5);
    ASSERT_TRUE(before.has_value());
    EXPECT_NEAR(glm::length(*before + incoming), 0.0, 1e-9);
  }
  // Beyond the critical angle of 41.8 degrees, no light leaves the glass.
  EXPECT_FALSE(refracted(glm::normalize(dvec3(0.7, 0.0, -0.7)), normal, 1.5).has_value());
}

TEST(Whitted, AHighlightIsBrightestWhereAMirrorWouldSendTheLight) {
  scenes::SceneBuilder builder = with_light({4.0, 0.0, 4.0});
  builder.set_background({0, 0, 0});
  builder.set_surface({.diffuse = 0.0F, .specular = 0.5F, .shine = 6.0F});
  add_floor(builder, 0.0);
  const scenes::Scene scene = std::move(builder).build();
  expect_color(seen(scene, {-3, 0, 3}, {1, 0, -1}), dvec3(0.5));
  // Seen from directly above, 45 degrees off: half of the square, to the power of 3.
  expect_color(seen(scene, {0, 0, 3}, {0, 0, -1}), dvec3(0.5 / 8.0));
}

TEST(Whitted, ASmoothPolygonIsLitByItsShadingNormal) {
  scenes::SceneBuilder builder = with_light({0.0, 0.0, 4.0});
  builder.set_surface({.color = {1, 1, 1}, .diffuse = 1.0F});
  const std::array<dvec3, 3> corners{dvec3(-9, -9, 0), dvec3(9, -9, 0), dvec3(0, 9, 0)};
  const std::array<dvec3, 3> normals{dvec3(0.6, 0, 0.8), dvec3(0.6, 0, 0.8), dvec3(0.6, 0, 0.8)};
  builder.add_polygon(corners, normals);
  const scenes::Scene scene = std::move(builder).build();
  expect_color(seen(scene, {0, 0, 5}, {0, 0, -1}), dvec3(kAmbient + 0.8));
}

/// Returns a slab of glass, 2 thick, above a floor whose color changes at x = `edge`.
scenes::Scene slab_above_two_floors(double edge) {
  scenes::SceneBuilder builder = with_light({0.0, 0.0, 90.0});
  builder.set_surface({.diffuse = 0.0F, .transmittance = 1.0F, .refraction_index = 1.5F});
  add_floor(builder, 2.0);
  add_floor(builder, 0.0);
  for (const bool right : {false, true}) {
    const double low = right ? edge : -20.0;
    const double high = right ? 20.0 : edge;
    builder.set_surface({.color = right ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0)});
    builder.add_polygon(std::array<dvec3, 4>{dvec3(low, -20, -1), dvec3(high, -20, -1),
                                             dvec3(high, 20, -1), dvec3(low, 20, -1)});
  }
  return std::move(builder).build();
}

TEST(Whitted, ASlabOfGlassShiftsARay) {
  // Enters at x = 0 at 45 degrees; in the slab the sine is sqrt(1/2) / 1.5, so a depth of 2 moves
  // the ray 1.06904 sideways; it leaves at 45 degrees again, for 1 more. Through air it would be 3.
  const double aside = 2.0 * std::tan(std::asin(std::sqrt(0.5) / 1.5)) + 1.0;
  for (const double beside : {-1e-3, 1e-3}) {
    const dvec3 color = seen(slab_above_two_floors(aside + beside), {-3, 0, 5}, {1, 0, -1});
    EXPECT_EQ(color.x > 0.0, beside > 0.0) << "red on the left of the edge";
    EXPECT_EQ(color.z > 0.0, beside < 0.0);
  }
}

/// Returns a glass bar along y whose section is the right angle (0, 0), (2, 2), (0, 2) of x and z,
/// below a small white ceiling at z = 4, with the light between.
scenes::Scene prism_below_a_ceiling(float index) {
  scenes::SceneBuilder builder = with_light({1.0, 0.0, 3.0});
  builder.set_surface({.diffuse = 0.0F, .transmittance = 1.0F, .refraction_index = index});
  const auto add_side = [&](const dvec3& a, const dvec3& b) {
    const dvec3 along(0, 9, 0);
    builder.add_polygon(std::array<dvec3, 4>{a - along, b - along, b + along, a + along});
  };
  add_side({0, 0, 0}, {2, 0, 2});
  add_side({2, 0, 2}, {0, 0, 2});
  add_side({0, 0, 2}, {0, 0, 0});
  builder.set_surface({.color = {1, 1, 1}, .diffuse = 1.0F});
  builder.add_polygon(
      std::array<dvec3, 4>{dvec3(0, -1, 4), dvec3(2, -1, 4), dvec3(2, 1, 4), dvec3(0, 1, 4)});
  return std::move(builder).build();
}

TEST(Whitted, APrismTurnsARayByTotalReflection) {
  // The ray enters perpendicularly at x = 0, meets the long side at 45 degrees, and leaves upward,
  // perpendicularly, at z = 2: three rays follow the camera ray. The light is directly below the
  // point they hit.
  expect_color(seen(prism_below_a_ceiling(1.5F), {-5, 0, 1}, {1, 0, 0}), dvec3(kAmbient + 1.0));
  expect_color(seen(prism_below_a_ceiling(1.5F), {-5, 0, 1}, {1, 0, 0}, {.max_depth = 3}),
               dvec3(0.0));
  // With this index the critical angle is 56 degrees: the ray continues to the sky.
  expect_color(seen(prism_below_a_ceiling(1.2F), {-5, 0, 1}, {1, 0, 0}), linear(0.2, 0.4, 0.8));
}

/// Returns the census of a ray that meets a plane at 60 degrees, behind which light is 1.5 times
/// faster; the critical angle is 41.8 degrees.
RayCensus census_at_total_reflection(double specular, const WhittedOptions& options) {
  scenes::SceneBuilder builder = with_light({0.0, 0.0, -50.0});
  builder.set_background({1, 1, 1});
  builder.set_surface({.diffuse = 0.0F,
                       .specular = static_cast<float>(specular),
                       .transmittance = 0.5F,
                       .refraction_index = 1.0F / 1.5F});
  add_floor(builder, 0.0);
  const scenes::Scene scene = std::move(builder).build();
  const auto structure = built(scene, "exhaustive");
  const Whitted tracer(scene, *structure, options);
  Whitted::Progress progress = tracer.begin();
  accel::Ray ray;
  ray.origin = {-3.4641016F, 0.0F, 2.0F};
  ray.direction = {0.8660254F, 0.0F, -0.5F};
  const dvec3 color = light_along(tracer, ray, structure->closest_hit(ray, nullptr), progress);
  const bool followed = options.max_depth > 1;
  expect_color(color, followed ? dvec3(specular + 0.5) : dvec3(0.0));
  return progress.census;
}

TEST(Whitted, TotalReflectionIsOneRayThatCarriesBothShares) {
  for (const double specular : {0.0, 0.25}) {
    SCOPED_TRACE(specular);
    const RayCensus census = census_at_total_reflection(specular, {});
    EXPECT_EQ(census.reflected, 1U);
    EXPECT_EQ(census.totally_reflected, 1U);
    EXPECT_EQ(census.refracted, 0U);
    const RayCensus spd = census_at_total_reflection(specular, {.glass_always_mirrors = true});
    EXPECT_EQ(spd, census);
  }
  EXPECT_EQ(census_at_total_reflection(0.25, {.max_depth = 1}).totally_reflected, 0U)
      << "no ray is spawned at the last depth";
}

TEST(Whitted, GlassSpawnsAnUnusedMirrorRayByTheRulesOfSpd) {
  scenes::SceneBuilder builder = with_light({0.0, 0.0, -50.0});
  builder.set_surface({.diffuse = 0.0F, .transmittance = 0.5F, .refraction_index = 1.5F});
  add_floor(builder, 0.0);
  const scenes::Scene scene = std::move(builder).build();
  const auto structure = built(scene, "exhaustive");
  accel::Ray ray;
  ray.origin = {0.0F, 0.0F, 5.0F};
  ray.direction = {0.3F, 0.0F, -1.0F};
  const auto census = [&](const WhittedOptions& options) {
    const Whitted tracer(scene, *structure, options);
    Whitted::Progress progress = tracer.begin();
    expect_color(light_along(tracer, ray, structure->closest_hit(ray, nullptr), progress),
                 0.5 * linear(0.2, 0.4, 0.8));
    return progress.census;
  };
  EXPECT_EQ(census({}).reflected, 0U);
  EXPECT_EQ(census({.glass_always_mirrors = true}).reflected, 1U);
  EXPECT_EQ(census({.glass_always_mirrors = true}).refracted, 1U);
}

TEST(Whitted, AShadingNormalSendsNoRefractedRayBackThroughItsSurface) {
  scenes::SceneBuilder builder = with_light({0.0, 0.0, -4.0});
  builder.set_surface({.diffuse = 0.0F, .transmittance = 1.0F, .refraction_index = 1.0F / 1.5F});
  const std::array<dvec3, 3> corners{dvec3(-9, -9, 0), dvec3(9, -9, 0), dvec3(0, 9, 0)};
  const dvec3 leaning(-0.6, 0.0, 0.8);
  builder.add_polygon(corners, std::array<dvec3, 3>{leaning, leaning, leaning});
  const scenes::Scene scene = std::move(builder).build();
  // The ray is 75 degrees from the plane's normal and 38 from the shading normal. For the latter,
  // Snell's law yields an upward direction. For the plane's normal it has no solution, so all light
  // is reflected.
  const auto structure = built(scene, "exhaustive");
  const Whitted tracer(scene, *structure, WhittedOptions{});
  Whitted::Progress progress = tracer.begin();
  accel::Ray ray;
  ray.origin = {-3.8637F, 0.0F, 1.0353F};
  ray.direction = {0.9659258F, 0.0F, -0.2588190F};
  light_along(tracer, ray, structure->closest_hit(ray, nullptr), progress);
  EXPECT_EQ(progress.census.refracted, 0U);
  EXPECT_EQ(progress.census.reflected, 1U);
}

TEST(Whitted, OnlyALightBeforeTheSurfaceGetsAShadowRay) {
  for (const double height : {5.0, -5.0}) {
    scenes::SceneBuilder builder = with_light({3.0, 1.0, height});
    builder.set_surface({.color = {1, 1, 1}, .diffuse = 1.0F});
    add_floor(builder, 0.0);
    scenes::Camera camera;
    camera.from = {0.0F, 0.0F, 9.0F};
    builder.add_camera(camera);
    const scenes::Scene scene = std::move(builder).build();
    const RayCensus census = picture(scene, "sah-bvh", {}).census;
    EXPECT_EQ(census.eye_hits, 40U * 30U);
    EXPECT_EQ(census.shadow, height > 0.0 ? census.eye_hits : 0U);
    EXPECT_EQ(census.shadow_hidden, 0U);
  }
}

TEST(Whitted, ClassicStructuresGiveTheSameBits) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = scene_of_all_surfaces(seed);
    const WhittedPicture expected = picture(scene, "exhaustive", {});
    for (const char* spec : {"samet", "samet-net", "glassner", "gargantini", "voxel-grid",
                             "goldsmith-salmon", "sah-bvh", "beam"}) {
      SCOPED_TRACE(spec);
      const WhittedPicture found = picture(scene, spec, {});
      expect_same_bits(found.image, expected.image);
      EXPECT_EQ(found.census, expected.census);
    }
  }
}

TEST(Whitted, PictureAndCensusDoNotDependOnTheThreads) {
  const scenes::Scene scene = scenes::load_scene("balls:n=2");
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

TEST(Whitted, DrawingInOrderYieldsTheSamePicture) {
  const scenes::Scene scene = scenes::load_scene("balls:n=1");
  const auto structure = built(scene, "samet");
  const accel::PrimaryRays rays(scene.cameras.front(), 40, 30, 1);
  accel::HitBuffer hits(40, 30, 1);
  structure->closest_hits(rays, hits, {});
  const Whitted tracer(scene, *structure, WhittedOptions{});
  const WhittedPicture expected = whitted_picture(tracer, rays, hits);
  Image image(40, 30);
  EXPECT_EQ(draw_in_order(tracer, rays, hits, image), expected.census);
  expect_same_bits(image, expected.image);
}

}  // namespace
}  // namespace beambench::render

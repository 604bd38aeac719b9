#pragma once
// Shared by the tests of the whole ray tracer: drawn rays and pictures, and hand-computed colors.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "harness/render/picture/color.hpp"
#include "harness/render/whitted_picture.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/random_scene.hpp"

namespace beambench {

inline std::unique_ptr<accel::Accelerator> built(const scenes::Scene& scene,
                                                 const std::string& spec) {
  return accel::registry().choose(parse_spec(spec)).build(scene);
}

/// Returns the light along one camera ray, the only one of its image.
inline glm::dvec3 light_along(const render::Whitted& tracer, const accel::Ray& ray,
                              const std::optional<accel::Hit>& hit,
                              render::Whitted::Progress& progress) {
  scenes::Camera camera;
  camera.from = ray.origin;
  camera.at = ray.origin + ray.direction;
  const accel::PrimaryRays image(camera, 1, 1, 1);
  const std::uint32_t sample = 0;
  glm::dvec3 color;
  tracer.trace_light({&image, {&ray, 1}, {&sample, 1}, {&hit, 1}}, {&color, 1}, progress);
  return color;
}

/// Returns the light seen along one ray.
inline glm::dvec3 seen(const scenes::Scene& scene, const glm::dvec3& origin,
                       const glm::dvec3& direction, const render::WhittedOptions& options = {}) {
  const auto structure = built(scene, "exhaustive");
  const render::Whitted tracer(scene, *structure, options);
  render::Whitted::Progress progress = tracer.begin();
  accel::Ray ray;
  ray.origin = glm::vec3(origin);
  ray.direction = glm::vec3(direction);
  return light_along(tracer, ray, structure->closest_hit(ray, nullptr), progress);
}

/// Compares colors with a tolerance for the small distance between surfaces and ray origins.
inline void expect_color(const glm::dvec3& color, const glm::dvec3& expected) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(color[i], expected[i], 2e-5) << "component " << i;
}

inline glm::dvec3 linear(double r, double g, double b) {
  return {render::linear_from_srgb(
      glm::vec3(static_cast<float>(r), static_cast<float>(g), static_cast<float>(b)))};
}

/// Adds a square of the plane z = height, 40 wide.
inline void add_floor(scenes::SceneBuilder& builder, double height) {
  const std::array<glm::dvec3, 4> corners{glm::dvec3(-20, -20, height), glm::dvec3(20, -20, height),
                                          glm::dvec3(20, 20, height), glm::dvec3(-20, 20, height)};
  builder.add_polygon(corners);
}

inline scenes::SceneBuilder with_light(const glm::dvec3& position,
                                       const glm::dvec3& color = glm::dvec3(1.0)) {
  scenes::SceneBuilder builder("by hand");
  builder.set_background({0.2, 0.4, 0.8});
  builder.add_light(position, color);
  return builder;
}

/// Returns a random scene with lights and mirrors, and with glass if the seed is even.
inline scenes::Scene scene_of_all_surfaces(std::uint64_t seed) {
  scenes::Scene scene = tests::random_scene(seed, 60);
  Random random(seed);
  scene.lights = {{{3.0F, 2.0F, 4.0F}, glm::vec3(1.0F)}, {{0.1F, 0.2F, 0.3F}, glm::vec3(0.5F)}};
  scene.surfaces = {{.color = {0.9F, 0.5F, 0.2F}, .diffuse = 0.8F},
                    {.diffuse = 0.3F, .specular = 0.6F, .shine = 20.0F},
                    {.diffuse = 0.2F, .transmittance = 0.7F, .refraction_index = 1.4F}};
  if (seed % 2 == 1) scene.surfaces.pop_back();
  for (scenes::Primitive& primitive : scene.primitives) {
    primitive.surface = static_cast<std::uint32_t>(random.below(scene.surfaces.size()));
  }
  return scene;
}

inline render::WhittedPicture picture(const scenes::Scene& scene, const std::string& spec,
                                      const render::WhittedOptions& options) {
  const auto structure = built(scene, spec);
  const accel::PrimaryRays rays(scene.cameras.front(), 40, 30, 1);
  accel::HitBuffer hits(40, 30, 1);
  structure->closest_hits(rays, hits, {});
  return render::whitted_picture(render::Whitted(scene, *structure, options), rays, hits);
}

inline void expect_same_bits(const render::Image& a, const render::Image& b) {
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) ASSERT_EQ(a.at(x, y), b.at(x, y)) << x << ", " << y;
  }
}

}  // namespace beambench

// Hits returned by a structure are checked before they are used.

#include "harness/rays/hit_check.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "accel/exhaustive/exhaustive.hpp"
#include "harness/rays/normal.hpp"
#include "harness/rays/ray_generators.hpp"
#include "harness/render/verified_picture.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/drawn.hpp"

namespace beambench::rays {
namespace {

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

/// Returns hits that are impossible for rays with the interval [0.5, 2] in a scene of three
/// primitives.
std::vector<accel::Hit> impossible_hits() {
  return {{1.0F, 3},
          {1.0F, 4'000'000'000U},
          {kNoNumber, 0},
          {accel::kInfinity, 0},
          {-accel::kInfinity, 0},
          {0.25F, 0},
          {2.5F, 0},
          {-1.0F, 0}};
}

scenes::Scene mirror_glass_and_wall() {
  scenes::SceneBuilder builder = with_light({4.0, 6.0, 8.0});
  builder.set_surface({.diffuse = 0.2F, .specular = 0.8F});
  add_floor(builder, -2.0);
  builder.set_surface({.diffuse = 0.1F, .transmittance = 0.8F, .refraction_index = 1.5F});
  builder.add_sphere({0.0, 0.0, 0.0}, 1.0);
  builder.set_surface({.diffuse = 0.9F});
  builder.add_sphere({0.0, 3.0, 0.0}, 1.0);
  return std::move(builder).build();
}

TEST(HitCheck, PassesOnlyHitsThatARayCanHave) {
  const scenes::Scene scene = mirror_glass_and_wall();
  ASSERT_EQ(scene.primitives.size(), 3U);
  const HitCheck check(scene, "structure 'x'");
  const accel::Ray ray{{0, 0, 0}, 0.5F, {0, 0, 1}, 2.0F};
  for (const float t : {0.5F, 1.0F, 2.0F}) EXPECT_TRUE(check.passes(ray, {t, 2}));
  EXPECT_TRUE(check.passes(accel::Ray{}, {0.0F, 0}));
  EXPECT_TRUE(check.passes(accel::Ray{}, {-0.0F, 0}));
  for (const accel::Hit& hit : impossible_hits()) EXPECT_FALSE(check.passes(ray, hit)) << hit.t;
}

/// The hits of exhaustive search, except for rays from `origin` that `chosen` selects, whose hits
/// are replaced.
class Planted : public accel::TraversalAccelerator<Planted> {
 public:
  using Chosen = std::function<bool(const accel::Ray&)>;
  Planted(const scenes::Scene& scene, const accel::Hit& fault, Chosen chosen)
      : exhaustive_(scene), fault_(fault), chosen_(std::move(chosen)) {}

  template <class Counting>
  std::optional<accel::Hit> find_closest(const accel::Ray& ray, Counting& counting) const {
    return chosen_(ray) ? std::optional(fault_) : exhaustive_.find_closest(ray, counting);
  }
  template <class Counting>
  bool find_any(const accel::Ray& ray, Counting& counting) const {
    return exhaustive_.find_any(ray, counting);
  }
  accel::Statistics statistics() const override { return {}; }

 private:
  accel::exhaustive::Exhaustive exhaustive_;
  accel::Hit fault_;
  Chosen chosen_;
};

/// Returns the errors thrown while a faulty structure draws a picture, alone and recorded.
std::vector<std::string> complaints(const scenes::Scene& scene, const accel::Hit& fault,
                                    const Planted::Chosen& chosen) {
  scenes::Camera camera;
  camera.from = {0.0F, -6.0F, 0.0F};
  camera.at = {0.0F, 0.0F, 0.0F};
  camera.up = {0.0F, 0.0F, 1.0F};
  camera.angle = 50.0F;
  const accel::PrimaryRays rays(camera, 16, 16, 1);
  const Planted structure(scene, fault, chosen);
  accel::HitBuffer hits(16, 16, 1);
  structure.closest_hits(rays, hits, {});
  const HitCheck check(scene, "structure 'planted:fault=1'");
  std::vector<std::string> messages;
  const auto note = [&](const auto& draw) {
    try {
      draw();
      messages.emplace_back("nothing was thrown");
    } catch (const InvalidHit& error) {
      messages.emplace_back(error.what());
    }
  };
  note([&] { render::whitted_picture(render::Whitted(scene, structure, {}, check), rays, hits); });
  note([&] {
    render::record_picture(std::make_shared<const render::ShadedScene>(scene), structure, rays,
                           hits, {}, check);
  });
  return messages;
}

TEST(HitCheck, NoRayContinuesFromAnInvalidHit) {
  const scenes::Scene scene = mirror_glass_and_wall();
  const glm::vec3 eye(0.0F, -6.0F, 0.0F);
  const auto of_the_eye = [&](const accel::Ray& ray) { return ray.origin == eye; };
  const auto that_follow = [&](const accel::Ray& ray) {
    return ray.origin != eye && ray.t_max == accel::kInfinity;
  };
  const auto to_the_light = [&](const accel::Ray& ray) { return ray.t_max <= 1.0F; };
  for (const accel::Hit& fault : {accel::Hit{1.0F, 3}, accel::Hit{kNoNumber, 0},
                                  accel::Hit{accel::kInfinity, 0}, accel::Hit{-1.0F, 0}}) {
    for (const Planted::Chosen& chosen : {Planted::Chosen(of_the_eye), Planted::Chosen(that_follow),
                                          Planted::Chosen(to_the_light)}) {
      for (const std::string& message : complaints(scene, fault, chosen)) {
        EXPECT_TRUE(message.starts_with("structure 'planted:fault=1' returned an invalid hit: "))
            << message;
        EXPECT_NE(message.find("for the ray from ("), std::string::npos) << message;
        EXPECT_NE(message.find("one of the scene's 3 primitives"), std::string::npos) << message;
      }
    }
  }
  const auto none = [](const accel::Ray&) { return false; };
  for (const std::string& message : complaints(scene, {}, none)) {
    EXPECT_EQ(message, "nothing was thrown");
  }
}

TEST(HitCheck, NamesThePixel) {
  const scenes::Scene scene = mirror_glass_and_wall();
  const accel::PrimaryRays rays(scene.cameras.front(), 5, 4, 4);
  accel::HitBuffer hits(5, 4, 4);
  HitCheck(scene).require(hits, rays);
  hits.set(hits.index(3, 2, 1), accel::Hit{kNoNumber, 1});
  try {
    HitCheck(scene).require(hits, rays);
    FAIL();
  } catch (const InvalidHit& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("primitive 1 at t = nan, at pixel (3, 2) sample 1, for the ray from"),
              std::string::npos)
        << message;
  }
}

/// Primitives so small that t rounds to their exact center, where the normal is undefined.
TEST(HitCheck, RaysFromTheSmallestThingsAreFinite) {
  scenes::SceneBuilder builder = with_light({4.0, 6.0, 8.0});
  builder.set_surface({.diffuse = 0.2F, .specular = 0.5F, .transmittance = 0.3F});
  builder.add_sphere({0.0, 0.0, 0.0}, 1e-12);
  builder.add_cone({1.0, 0.0, 0.0}, 1e-12, {1.0, 1e-12, 0.0}, 1e-12);
  add_floor(builder, -2.0);
  const scenes::Scene scene = std::move(builder).build();
  const auto finite = [](const auto& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  for (const scenes::PrimitiveId id : {0U, 1U}) {
    const accel::Ray ray{
        {static_cast<float>(id), 0.0F, 5.0F}, 0.0F, {0.0F, 0.0F, -1.0F}, accel::kInfinity};
    const accel::Hit hit{5.0F, id};  // as rounded
    const glm::dvec3 normal = geometric_normal(scene, ray, hit);
    ASSERT_TRUE(finite(normal)) << id;
    EXPECT_NEAR(glm::length(normal), 1.0, 1e-9) << id;
    EXPECT_LE(glm::dot(normal, glm::dvec3(ray.direction)), 0.0) << id;
    ASSERT_TRUE(finite(shading_normal(scene, ray, hit))) << id;
    const accel::exhaustive::Exhaustive structure(scene);
    const render::Whitted tracer(scene, structure, {});
    render::Whitted::Progress progress = tracer.begin();
    EXPECT_TRUE(finite(light_along(tracer, ray, hit, progress))) << id;
  }
}

}  // namespace
}  // namespace beambench::rays

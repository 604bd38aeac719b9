// tile-beam: images are correct up to rounding and without gaps; single rays are exact bit for bit.

#include "accel/tile_beam/tile_beam.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "accel/core/registry.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/only_target.hpp"
#include "tests/random_scene.hpp"
#include "tests/random_view.hpp"

namespace beambench::accel {
namespace {

using tests::random_ray;
using tests::random_scene;

scenes::Camera random_camera(const scenes::Scene& scene, Random& random) {
  scenes::Camera camera = tests::random_view(scene, random);
  const glm::vec3 view = glm::abs(camera.at - camera.from);
  camera.up = glm::vec3(0.0F);
  camera.up[view.y < view.x || view.y < view.z ? 1 : 0] = 1.0F;
  camera.angle = static_cast<float>(random.uniform(20.0, 110.0));
  camera.aspect = static_cast<float>(random.uniform(0.6, 1.8));
  return camera;
}

/// Returns the distance below which float cannot distinguish two points: K u of the differ.
double indistinct(const scenes::Scene& scene, const glm::vec3& eye) {
  return 16.0 * 0x1p-24 *
         (static_cast<double>(scene.bounds.largest_coordinate()) + glm::length(glm::dvec3(eye)));
}

/// Returns whether rays close to the given one, at the distance of the hits in question, produce
/// both results. If so, the results differ only by rounding.
bool is_close_call(const exhaustive::Exhaustive& exhaustive, const Ray& ray,
                   const std::optional<Hit>& answer, double slack) {
  const float t = answer ? answer->t : 1.0F;
  const glm::dvec3 d(ray.direction);
  const glm::dvec3 side = glm::normalize(glm::cross(
      d, std::abs(d.x) < 0.5 * glm::length(d) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
  const glm::dvec3 other = glm::normalize(glm::cross(d, side));
  for (const double reach : {1.0, 4.0}) {
    for (int i = 0; i < 32; ++i) {
      const double angle = 6.283185307179586 * i / 32.0;
      Ray near = ray;
      const double away = reach * slack / (answer ? std::max(t, 1e-6F) : 1.0);
      near.direction = glm::vec3(d + (side * std::cos(angle) + other * std::sin(angle)) * away);
      const auto hit = exhaustive.closest_hit(near, nullptr);
      if (hit.has_value() != answer.has_value()) continue;
      if (!hit) return true;
      if (hit->primitive == answer->primitive) return true;
      if (std::abs(hit->t - t) <= 8.0 * slack) return true;
    }
  }
  return false;
}

struct Comparison {
  std::size_t hits = 0;
  std::size_t close_calls = 0;
  std::size_t errors = 0;
  std::string first;
};

/// Compares an image with exhaustive search, sample by sample.
Comparison compare(const scenes::Scene& scene, const PrimaryRays& rays, const HitBuffer& image) {
  const exhaustive::Exhaustive exhaustive(scene);
  const double slack = indistinct(scene, rays.eye());
  Comparison found;
  for (int y = 0; y < rays.height(); ++y) {
    for (int x = 0; x < rays.width(); ++x) {
      for (int sample = 0; sample < rays.samples(); ++sample) {
        const Ray ray = rays.ray(x, y, sample);
        const auto expected = exhaustive.closest_hit(ray, nullptr);
        const auto actual = image.get(image.index(x, y, sample));
        if (expected) ++found.hits;
        if (expected == actual) continue;
        const double length = glm::length(glm::dvec3(ray.direction));
        if (expected && actual && std::abs(expected->t - actual->t) * length <= 4.0 * slack)
          continue;
        if (is_close_call(exhaustive, ray, actual, slack)) {
          ++found.close_calls;
          continue;
        }
        if (found.errors++ == 0) {
          found.first = fmt::format(
              "({}, {}) sample {}: expected {} at {}, got {} at {}", x, y, sample,
              expected ? expected->primitive : scenes::kNoPrimitive, expected ? expected->t : -1,
              actual ? actual->primitive : scenes::kNoPrimitive, actual ? actual->t : -1);
        }
      }
    }
  }
  return found;
}

HitBuffer image_of(const tile_beam::TileBeam& structure, const PrimaryRays& rays) {
  HitBuffer image(rays.width(), rays.height(), rays.samples());
  std::fill_n(image.t(), image.size(), -1.0F);  // reveals entries that were not written
  structure.closest_hits(rays, image, {});
  return image;
}

TEST(TileBeam, ImagesOfRandomScenesMatchExhaustive) {
  std::size_t hits = 0;
  std::size_t samples = 0;
  std::size_t close_calls = 0;
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    Random random(seed);
    const scenes::Scene scene = verify::random_scene(seed, static_cast<int>(1 + random.below(80)));
    const scenes::Camera camera = random_camera(scene, random);
    const int pattern[] = {1, 5, 9, 1};
    const PrimaryRays rays(camera, static_cast<int>(1 + random.below(90)),
                           static_cast<int>(1 + random.below(90)), pattern[random.below(4)]);
    const tile_beam::TileBeam structure(
        scene, {.max_leaf = static_cast<std::uint32_t>(1 + random.below(32))});
    const Comparison found = compare(scene, rays, image_of(structure, rays));
    EXPECT_EQ(found.errors, 0U) << "seed " << seed << ", " << rays.width() << "x" << rays.height()
                                << "x" << rays.samples() << " first " << found.first;
    hits += found.hits;
    close_calls += found.close_calls;
    samples += rays.count();
  }
  EXPECT_GT(hits, samples / 5);
  EXPECT_LT(hits, samples * 4 / 5);
  EXPECT_LT(close_calls, samples / 500);
}

TEST(TileBeam, ImagesOfCatalogScenesMatchExhaustive) {
  for (const char* name : {"tetra:n=4", "balls:n=2", "escena1", "escena2", "bumpy:triangles=768"}) {
    const scenes::Scene scene = scenes::load_scene(name);
    const tile_beam::TileBeam structure(scene, {});
    for (const int samples : {1, 5, 9}) {
      const PrimaryRays rays(scene.cameras.front(), 67, 53, samples);
      const Comparison found = compare(scene, rays, image_of(structure, rays));
      EXPECT_EQ(found.errors, 0U) << name << " x" << samples << " first " << found.first;
    }
  }
}

/// An eye that touches the scene: hits at t = 0 lie in the interval.
struct Touching {
  std::string name;
  scenes::Scene scene;
  glm::vec3 eye;
};

std::vector<Touching> touching_eyes() {
  std::vector<Touching> all;
  const auto add = [&](const char* name, scenes::SceneBuilder builder, const glm::vec3& eye) {
    all.push_back({name, std::move(builder).build(), eye});
  };
  const std::vector<glm::dvec3> square{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const std::vector<glm::dvec3> leaning{{-1, -1, -1}, {1, 0, 0}, {0, 1, 2}};
  const std::vector<glm::dvec3> angle{{0, 0, 0}, {2, 0, 0}, {2, 1, 0},
                                      {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};  // concave
  const auto polygon = [](const std::vector<glm::dvec3>& corners) {
    scenes::SceneBuilder builder("polygon");
    builder.add_polygon(corners);
    builder.add_sphere({0.0, 0.0, 5.0}, 1.0);
    return builder;
  };
  add("in a square", polygon(square), {0, 0, 0});
  add("on the diagonal of a square's two triangles", polygon(square), {0.5F, 0.5F, 0});
  add("on the edge of a square", polygon(square), {1, 0.25F, 0});
  add("at the corner of a square", polygon(square), {-1, 1, 0});
  add("beside a square, in its plane", polygon(square), {1.5F, 0, 0});
  add("at the corner of a triangle", polygon(leaning), {1, 0, 0});
  add("in the middle of a triangle's edge", polygon(leaning), {0.5F, 0.5F, 1});
  add("in a concave polygon", polygon(angle), {0.5F, 1.5F, 0});
  add("at the corner where it is concave", polygon(angle), {1, 1, 0});
  add("where it is cut out", polygon(angle), {1.5F, 1.5F, 0});

  const auto sphere = [](double radius) {
    scenes::SceneBuilder builder("sphere");
    builder.add_sphere({1.0, 0.0, 0.0}, radius);
    return builder;
  };
  add("on a sphere", sphere(1.0), {0, 0, 0});
  add("on a sphere seen from the inside only", sphere(-1.0), {0, 0, 0});
  scenes::SceneBuilder kissing("kissing spheres");
  for (const glm::dvec3& center :
       {glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0), glm::dvec3(1, 1, 0), glm::dvec3(0, 1, 1)}) {
    kissing.add_sphere(center, 0.5);
  }
  add("where spheres touch", std::move(kissing), {0.5F, 0, 0});

  const auto cone = [](double apex_radius) {
    scenes::SceneBuilder builder("cone");
    builder.add_cone({0.0, 0.0, 0.0}, 1.0, {0.0, 2.0, 0.0}, apex_radius);
    return builder;
  };
  add("on a cylinder", cone(1.0), {1, 0.5F, 0});
  add("on the rim of a cylinder", cone(1.0), {0, 2, 1});
  add("on a cone", cone(0.0), {0.5F, 1, 0});
  add("at the tip of a cone", cone(0.0), {0, 2, 0});
  return all;
}

/// Returns cameras that look along an axis, along a diagonal, and in another direction.
std::vector<scenes::Camera> cameras_at(const glm::vec3& eye) {
  std::vector<scenes::Camera> cameras;
  for (const glm::vec3& direction : {glm::vec3(1, 0, 0), glm::vec3(0, 0, -1), glm::vec3(-1, 1, 0),
                                     glm::vec3(0.3F, -0.8F, 0.4F)}) {
    scenes::Camera camera;
    camera.from = eye;
    camera.at = eye + direction;
    camera.up = std::abs(direction.y) < 0.75F ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1);
    camera.angle = 70.0F;
    cameras.push_back(camera);
  }
  return cameras;
}

/// Counts the samples that differ from exhaustive search in a hit at the eye. Other hits may differ
/// by rounding.
std::size_t wrong_at_eye(const scenes::Scene& scene, const PrimaryRays& rays,
                         const HitBuffer& image) {
  const exhaustive::Exhaustive exhaustive(scene);
  std::size_t wrong = 0;
  for (int y = 0; y < rays.height(); ++y) {
    for (int x = 0; x < rays.width(); ++x) {
      for (int sample = 0; sample < rays.samples(); ++sample) {
        const auto expected = exhaustive.closest_hit(rays.ray(x, y, sample), nullptr);
        const auto actual = image.get(image.index(x, y, sample));
        const auto at_eye = [](const auto& hit) { return hit && !(hit->t > 1e-5F); };
        if (!at_eye(expected) && !at_eye(actual)) continue;
        // Any of several hits at one point is valid.
        if (!expected || !actual || !(std::abs(expected->t - actual->t) <= 1e-12F)) ++wrong;
      }
    }
  }
  return wrong;
}

TEST(TileBeam, FindsHitsAtTheEye) {
  std::size_t at_zero = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const tests::OnlyTarget only(target);
    for (const Touching& touching : touching_eyes()) {
      const tile_beam::TileBeam structure(touching.scene, {});
      for (const scenes::Camera& camera : cameras_at(touching.eye)) {
        for (const auto& [width, samples] : {std::pair{33, 1}, {16, 1}, {9, 1}, {19, 5}, {8, 4}}) {
          const PrimaryRays rays(camera, width, 20, samples);
          const HitBuffer image = image_of(structure, rays);
          ASSERT_EQ(wrong_at_eye(touching.scene, rays, image), 0U)
              << "eye " << touching.name << ", " << width << " x " << samples;
          EXPECT_EQ(compare(touching.scene, rays, image).errors, 0U)
              << "eye " << touching.name << ", " << width << " x " << samples;
          at_zero +=
              static_cast<std::size_t>(std::count(image.t(), image.t() + image.size(), 0.0F));
        }
      }
    }
  }
  EXPECT_GT(at_zero, 100'000U);
}

TEST(TileBeam, FindsHitsAtTheOriginOfSingleRays) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const tests::OnlyTarget only(target);
    for (const Touching& touching : touching_eyes()) {
      const tile_beam::TileBeam structure(touching.scene, {});
      const exhaustive::Exhaustive exhaustive(touching.scene);
      Random random(3);
      for (int i = 0; i < 200; ++i) {
        Ray ray = verify::random_ray(touching.scene, random);
        ray.origin = touching.eye;
        ray.t_min = 0.0F;
        for (const float t_max : {kInfinity, 1.0F, 0.0F}) {
          ray.t_max = t_max;
          const auto hit = exhaustive.closest_hit(ray, nullptr);
          ASSERT_EQ(structure.closest_hit(ray, nullptr), hit) << "eye " << touching.name;
          ASSERT_EQ(structure.any_hit(ray, nullptr), hit.has_value()) << "eye " << touching.name;
        }
      }
    }
  }
}

TEST(TileBeam, OnePixelIsAnImage) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=3");
  const tile_beam::TileBeam structure(scene, {});
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 97}, {131, 1}, {127, 65}, {128, 64}, {129, 63}}) {
    const PrimaryRays rays(scene.cameras.front(), width, height, 1);
    EXPECT_EQ(compare(scene, rays, image_of(structure, rays)).errors, 0U) << width << 'x' << height;
  }
}

/// A closed mesh seen from inside: every sample must be covered, wherever edges and vertices are.
TEST(TileBeam, AClosedMeshHasNoGap) {
  for (const char* name : {"bumpy:triangles=768", "bumpy:triangles=12288"}) {
    const scenes::Scene scene = scenes::load_scene(name);
    const tile_beam::TileBeam structure(scene, {});
    Random random(5);
    std::size_t background = 0;
    for (int view = 0; view < 200; ++view) {
      scenes::Camera camera = random_camera(scene, random);
      const glm::vec3 middle = 0.5F * (scene.bounds.lower + scene.bounds.upper);
      // The eye is well inside: the mesh is a bumpy sphere whose radius is at least a quarter of
      // its box's side.
      const glm::vec3 to = 0.2F * (scene.bounds.upper - scene.bounds.lower);
      for (int axis = 0; axis < 3; ++axis) {
        camera.from[axis] = middle[axis] + to[axis] * static_cast<float>(random.uniform(-1.0, 1.0));
        camera.at[axis] = camera.from[axis] + static_cast<float>(random.uniform(-1.0, 1.0));
      }
      const PrimaryRays rays(camera, 200, 150, 1);
      const HitBuffer image = image_of(structure, rays);
      background += static_cast<std::size_t>(
          std::count(image.primitive(), image.primitive() + image.size(), scenes::kNoPrimitive));
    }
    EXPECT_EQ(background, 0U) << name;
  }
}

/// A room whose walls are two triangles each: nearly all of them cross the plane of the eye.
TEST(TileBeam, WallsBehindTheEyeLeaveNoGap) {
  scenes::SceneBuilder builder("box");
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {0.0, 1.0}) {
      std::vector<glm::dvec3> corners(4, glm::dvec3(0.0));
      for (glm::dvec3& corner : corners) corner[axis] = side;
      corners[1][(axis + 1) % 3] = corners[2][(axis + 1) % 3] = 1.0;
      corners[2][(axis + 2) % 3] = corners[3][(axis + 2) % 3] = 1.0;
      builder.add_polygon(corners);
    }
  }
  const scenes::Scene scene = std::move(builder).build();
  const tile_beam::TileBeam structure(scene, {});
  Random random(9);
  for (int view = 0; view < 60; ++view) {
    scenes::Camera camera = random_camera(scene, random);
    for (int axis = 0; axis < 3; ++axis) {
      camera.from[axis] = static_cast<float>(random.uniform(0.001, 0.999));
    }
    const PrimaryRays rays(camera, 150, 120, 1);
    const HitBuffer image = image_of(structure, rays);
    EXPECT_EQ(std::count(image.primitive(), image.primitive() + image.size(), scenes::kNoPrimitive),
              0)
        << view;
    EXPECT_EQ(compare(scene, rays, image).errors, 0U) << view;
  }
}

TEST(TileBeam, BackgroundOfAnEmptySceneIsPainted) {
  const scenes::Scene scene = scenes::SceneBuilder("empty").build();
  const PrimaryRays rays(scenes::Camera{}, 70, 3, 5);
  EXPECT_EQ(image_of(tile_beam::TileBeam(scene, {}), rays), HitBuffer(70, 3, 5));
}

TEST(TileBeam, CrowdedTilesAreTracedBySingleRays) {
  const scenes::Scene scene = scenes::load_scene("bumpy:triangles=12288");
  const tile_beam::TileBeam structure(scene, {});
  const PrimaryRays rays(scene.cameras.front(), 7, 5, 1);
  HitBuffer image(7, 5, 1);
  WorkCounters counters;
  structure.closest_hits(rays, image, {&counters});
  EXPECT_GT(counters.by_name()["handed_over_rays"], 0U);
  EXPECT_EQ(compare(scene, rays, image).errors, 0U);
}

TEST(TileBeam, CountingChangesNoHit) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  const tile_beam::TileBeam structure(scene, {});
  const PrimaryRays rays(scene.cameras.front(), 200, 80, 1);
  HitBuffer counted(200, 80, 1);
  WorkCounters counters;
  structure.closest_hits(rays, counted, {&counters});
  EXPECT_EQ(counted, image_of(structure, rays));
  EXPECT_EQ(counters.by_name()["beams"], 2U);
  EXPECT_GT(counters.get(Counter::kLeaves), 0U);
}

TEST(TileBeam, ThreadsChangeNoHitAndNoCount) {
  for (const char* name : {"escena1", "bumpy:triangles=12288", "escena2"}) {
    const scenes::Scene scene = scenes::load_scene(name);
    const tile_beam::TileBeam alone(scene, {});
    const tile_beam::TileBeam together(scene, {.parallel = true});
    for (const int samples : {1, 5}) {
      const PrimaryRays rays(scene.cameras.front(), 300, 170, samples);
      HitBuffer expected(300, 170, samples);
      HitBuffer image(300, 170, samples);
      WorkCounters expected_counters;
      WorkCounters counters;
      alone.closest_hits(rays, expected, {&expected_counters});
      together.closest_hits(rays, image, {&counters});
      EXPECT_EQ(image, expected) << name;
      EXPECT_EQ(counters.by_name(), expected_counters.by_name()) << name;
      EXPECT_EQ(image_of(together, rays), expected) << name;
    }
  }
}

TEST(TileBeam, ParallelBuildsAreTheSame) {
  const scenes::Scene scene = scenes::load_scene("bumpy:triangles=100000");
  const tile_beam::TileHierarchy alone = tile_beam::build_tile_hierarchy(scene, {});
  const tile_beam::TileHierarchy together =
      tile_beam::build_tile_hierarchy(scene, {.parallel = true});
  ASSERT_GT(alone.leaves(), 2048U);  // enough for several tasks
  ASSERT_EQ(together.nodes.size(), alone.nodes.size());
  ASSERT_EQ(together.meshlets.size(), alone.meshlets.size());
  EXPECT_EQ(together.depth, alone.depth);
  for (std::size_t i = 0; i < alone.nodes.size(); ++i) {
    const tile_beam::TileNode& node = alone.nodes[i];
    const tile_beam::TileNode& other = together.nodes[i];
    ASSERT_EQ(other.count, node.count) << i;
    ASSERT_EQ(other.boxes.planes, node.boxes.planes) << i;
    ASSERT_EQ(other.leaves, node.leaves) << i;
    for (std::size_t lane = 0; lane < node.count; ++lane) {
      ASSERT_EQ(other.children[lane].bits(), node.children[lane].bits()) << i;
    }
  }
  for (std::size_t i = 0; i < alone.meshlets.size(); ++i) {
    ASSERT_EQ(together.meshlets[i].vertices, alone.meshlets[i].vertices) << i;
    ASSERT_EQ(together.meshlets[i].corners, alone.meshlets[i].corners) << i;
    ASSERT_EQ(together.meshlets[i].primitives, alone.meshlets[i].primitives) << i;
  }
}

TEST(TileBeam, EveryInstructionSetIsCorrect) {
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  ASSERT_GE(targets.size(), HWY_ARCH_X86 ? 2U : 1U) << "no choice at run time was compiled in";
  for (const std::int64_t target : targets) {
    SCOPED_TRACE(hwy::TargetName(target));
    const tests::OnlyTarget only(target);
    for (const char* name : {"tetra:n=4", "balls:n=2", "bumpy:triangles=3072"}) {
      const scenes::Scene scene = scenes::load_scene(name);
      const tile_beam::TileBeam structure(scene, {});
      ASSERT_STREQ(structure.instruction_set(), hwy::TargetName(target));
      for (const int width : {131, 512}) {  // in one, rows are whole cache lines
        const PrimaryRays rays(scene.cameras.front(), width, 21, 1);
        const Comparison found = compare(scene, rays, image_of(structure, rays));
        EXPECT_EQ(found.errors, 0U) << name << " first " << found.first;
      }
    }
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Random random(seed);
      const scenes::Scene scene = verify::random_scene(seed, 60);
      const tile_beam::TileBeam structure(scene, {});
      const PrimaryRays rays(random_camera(scene, random), 50, 40, 1);
      EXPECT_EQ(compare(scene, rays, image_of(structure, rays)).errors, 0U) << "seed " << seed;
      for (int i = 0; i < 100; ++i) {
        const Ray ray = verify::random_ray(scene, random);
        ASSERT_EQ(structure.closest_hit(ray, nullptr),
                  exhaustive::Exhaustive(scene).closest_hit(ray, nullptr));
      }
    }
  }
}

TEST(TileBeam, CanBeRestrictedToAnInstructionSet) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=2");
  const auto best = registry().choose({"tile-beam", {}}).build(scene);
  EXPECT_EQ(best->statistics().instruction_set, best_simd_target());
  if ((hwy::SupportedTargets() & HWY_AVX2) == 0) GTEST_SKIP() << "this machine has no AVX2";
  const auto held = registry().choose({"tile-beam", {{"isa", "avx2"}}}).build(scene);
  EXPECT_EQ(held->statistics().instruction_set, "AVX2");
}

TEST(TileBeam, LargeImagesUseStreamingStores) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=3");
  const tile_beam::TileBeam structure(scene, {});
  const PrimaryRays rays(scene.cameras.front(), 448, 301, 1);  // large enough, and odd
  EXPECT_EQ(compare(scene, rays, image_of(structure, rays)).errors, 0U);
}

TEST(TileBeam, SingleRaysAreExact) {
  for (std::uint64_t seed = 1; seed <= 80; ++seed) {
    Random random(seed);
    const scenes::Scene scene = verify::random_scene(seed, static_cast<int>(1 + random.below(120)));
    const tile_beam::TileBeam structure(
        scene, {.max_leaf = static_cast<std::uint32_t>(1 + random.below(32))});
    const exhaustive::Exhaustive exhaustive(scene);
    for (int i = 0; i < 200; ++i) {
      const Ray ray = verify::random_ray(scene, random);
      const auto hit = exhaustive.closest_hit(ray, nullptr);
      ASSERT_EQ(structure.closest_hit(ray, nullptr), hit) << "seed " << seed << " ray " << i;
      ASSERT_EQ(structure.any_hit(ray, nullptr), hit.has_value())
          << "seed " << seed << " ray " << i;
    }
  }
}

}  // namespace
}  // namespace beambench::accel

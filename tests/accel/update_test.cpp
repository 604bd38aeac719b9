// Structures over moving scenes: after an update they return the hits of exhaustive search and of a
// rebuilt structure.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "accel/core/moved_structure.hpp"
#include "accel/core/registry.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "harness/verify/differ.hpp"
#include "scenes/animation.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "tests/hits_of_exhaustive.hpp"
#include "tests/number_from.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

using scenes::Animation;
using scenes::Pose;
using scenes::Scene;

/// The exact structures that can be updated, each with the options that affect updates.
const std::vector<std::string> kExact{"goldsmith-salmon",
                                      "goldsmith-salmon:insert=terminal",
                                      "sah-bvh",
                                      "sah-bvh:lists=single,parallel=true",
                                      "sah-bvh:builder=spatial",
                                      "sah-bvh:builder=spatial,collapse=cost",
                                      "exhaustive"};

std::string updated(const std::string& spec) {
  if (spec == "exhaustive") return spec;
  return spec + (spec.find(':') == std::string::npos ? ":" : ",") + "update=true";
}

std::unique_ptr<Accelerator> build(const Scene& scene, const std::string& spec) {
  return registry().choose(parse_spec(spec)).build(scene);
}

/// Returns a random scene whose points all move: together, independently, or to one position.
Animation random_animation(std::uint64_t seed, std::uint32_t frames) {
  Animation animation{tests::random_scene(seed, 60), frames, {}};
  animation.pose = [first = scenes::pose_of(animation.scene), seed](std::uint32_t frame) {
    Pose pose = first;
    if (frame == 0) return pose;
    Random random(1000 * seed + frame);
    const double together = random.uniform(-1.0, 1.0);
    const double apart = random.below(3) == 0 ? 2.0 : 0.05;
    const bool falls_together = random.below(6) == 0;
    const auto move = [&](glm::vec3& point) {
      if (falls_together) point = glm::vec3(0.25F);
      for (int axis = 0; axis < 3; ++axis) {
        if (falls_together && axis != 1) continue;
        point[axis] += static_cast<float>(together + random.uniform(-apart, apart));
      }
    };
    for (glm::vec3& vertex : pose.vertices) move(vertex);
    for (scenes::Sphere& sphere : pose.spheres) move(sphere.center);
    for (scenes::Cone& cone : pose.cones) {
      move(cone.base);
      move(cone.apex);
    }
    return pose;
  };
  return animation;
}

/// Expects the hits of exhaustive search for lists of rays long enough for streams.
void expect_lists_of_exhaustive(const Scene& scene, const Accelerator& structure,
                                std::uint64_t seed) {
  Random random(seed);
  const std::vector<Ray> rays = verify::random_rays(scene, 400, random);
  HitBuffer closest(static_cast<int>(rays.size()), 1, 1);
  structure.closest_hits(RayBatch{rays}, closest, {});
  const exhaustive::Exhaustive exhaustive(scene);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(closest.get(i), exhaustive.closest_hit(rays[i])) << "ray " << i;
  }
}

TEST(Update, RandomAnimationsMatchExhaustiveInEachFrame) {
  const std::uint64_t animations = tests::in_full(1000, 6);
  constexpr std::uint32_t kFrames = 20;
  for (std::uint64_t seed = 1; seed <= animations; ++seed) {
    Animation animation = random_animation(seed, kFrames);
    Scene moving = animation.scene;
    std::vector<std::unique_ptr<Accelerator>> structures;
    structures.reserve(kExact.size());
    for (const std::string& spec : kExact) structures.push_back(build(moving, spec));
    for (std::uint32_t frame = 1; frame < kFrames; ++frame) {
      scenes::set_pose(moving, animation.pose(frame), frame);
      for (std::size_t i = 0; i < structures.size(); ++i) {
        SCOPED_TRACE(testing::Message()
                     << kExact[i] << ", animation " << seed << ", frame " << frame);
        ASSERT_TRUE(structures[i]->update(moving));
        tests::expect_hits_of_exhaustive(moving, *structures[i], seed + frame, 20);
        if (frame % 5 == 0) expect_lists_of_exhaustive(moving, *structures[i], seed + frame);
      }
    }
  }
}

TEST(Update, CatalogFramesMatchARebuiltStructure) {
  for (const scenes::SceneInfo& info : scenes::scene_catalogue()) {
    if (!info.animate) continue;
    for (const char* frame : {"@1", "@19"}) {
      const Scene scene = scenes::load_scene(info.name + frame);
      std::vector<std::string> specs = kExact;
      specs.emplace_back("tile-beam");
      const PrimaryRays rays(scene.cameras.front(), 60, 45, 1);
      HitBuffer expected(60, 45, 1);
      build(scene, "sah-bvh")->closest_hits(rays, expected, {});
      for (const std::string& spec : specs) {
        if (spec == "exhaustive") continue;
        SCOPED_TRACE(info.name + frame + " " + spec);
        HitBuffer hits(60, 45, 1);
        build(scene, updated(spec))->closest_hits(rays, hits, {});
        if (spec != "tile-beam") {
          EXPECT_EQ(hits, expected);
          continue;
        }
        HitBuffer anew(60, 45, 1);
        build(scene, spec)->closest_hits(rays, anew, {});
        std::size_t other = 0;
        for (std::size_t i = 0; i < rays.count(); ++i) {
          if (hits.get(i) != anew.get(i)) ++other;
        }
        // Equal up to the tolerance, which only matters where two surfaces meet.
        EXPECT_LE(other, 5U);
      }
    }
  }
}

TEST(Update, OnlyBoxesChange) {
  const Scene scene = scenes::load_scene("waving-sheet:triangles=2000@10");
  for (const char* spec : {"sah-bvh", "goldsmith-salmon"}) {
    const Statistics before = build(*scene.first_frame, spec)->statistics();
    const Statistics after = build(scene, updated(spec))->statistics();
    EXPECT_EQ(before.nodes, after.nodes) << spec;
    EXPECT_EQ(before.references, after.references) << spec;
    EXPECT_EQ(before.depth, after.depth) << spec;
  }
}

TEST(Update, WithoutMotionChangesNoHitAndNoWork) {
  for (const char* name : {"escena1", "tetra:n=3", "gears:n=2"}) {
    const Scene scene = scenes::load_scene(name);
    const PrimaryRays rays(scene.cameras.front(), 80, 60, 1);
    for (const std::string& spec : kExact) {
      if (spec == "exhaustive" || spec.find("spatial") != std::string::npos) continue;
      HitBuffer expected(80, 60, 1), hits(80, 60, 1);
      WorkCounters built_work, updated_work;
      build(scene, spec)->closest_hits(rays, expected, {&built_work});
      build(scene, updated(spec))->closest_hits(rays, hits, {&updated_work});
      EXPECT_EQ(hits, expected) << spec;
      EXPECT_EQ(built_work.by_name(), updated_work.by_name()) << spec;
    }
  }
}

TEST(Update, AStructureThatCannotBeUpdatedReportsIt) {
  Scene scene = scenes::load_scene("escena1");
  EXPECT_FALSE(build(scene, "samet")->update(scene));
  EXPECT_FALSE(build(scene, "tile-beam")->update(scene));
  EXPECT_FALSE(build(scene, "embree")->update(scene));
  EXPECT_THROW(build(scene, "tile-beam:update=true,backface_culling=true"), InputError);
}

TEST(Update, EveryStructureBuildsOverDegenerateFrames) {
  Animation animation{tests::random_scene(7, 40), 2, {}};
  animation.pose = [first = scenes::pose_of(animation.scene)](std::uint32_t) {
    Pose pose = first;
    for (glm::vec3& vertex : pose.vertices) vertex = glm::vec3(1.0F, 2.0F, 3.0F);
    for (scenes::Sphere& sphere : pose.spheres) sphere.center = glm::vec3(1.0F, 2.0F, 3.0F);
    for (scenes::Cone& cone : pose.cones) cone.base = cone.apex = glm::vec3(1.0F, 2.0F, 3.0F);
    return pose;
  };
  scenes::show_frame(animation, 1);
  const Scene& scene = animation.scene;
  for (const StructureInfo& info : registry().structures()) {
    if (info.conformance != Conformance::kBitExact || !info.support.single_rays) continue;
    SCOPED_TRACE(info.name);
    const auto structure = build(scene, info.name);
    tests::expect_hits_of_exhaustive(scene, *structure, 3, 200);
  }
  for (const std::string& spec : kExact) {
    SCOPED_TRACE(spec);
    tests::expect_hits_of_exhaustive(scene, *build(scene, updated(spec)), 3, 200);
  }
}

}  // namespace
}  // namespace beambench::accel

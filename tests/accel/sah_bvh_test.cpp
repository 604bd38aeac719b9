// The eight-wide hierarchy: its invariants, and the same hits from every instruction set.

#include "accel/bvh/sah_bvh.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "accel/core/padded_bounds.hpp"
#include "accel/core/tolerance.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/hits_of_exhaustive.hpp"
#include "tests/only_target.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

/// Builder and collapse.
class SahBvhBuilders
    : public ::testing::TestWithParam<std::tuple<bvh::BvhBuilder, bvh::BvhCollapse>> {
 protected:
  static bvh::SahBvhOptions options() {
    return {{{}, std::get<0>(GetParam()), std::get<1>(GetParam())}};
  }
};
INSTANTIATE_TEST_SUITE_P(
    All, SahBvhBuilders,
    ::testing::Combine(::testing::Values(bvh::BvhBuilder::kBinned, bvh::BvhBuilder::kSpatial),
                       ::testing::Values(bvh::BvhCollapse::kArea, bvh::BvhCollapse::kCost)),
    [](const auto& info) {
      return std::string(std::get<0>(info.param) == bvh::BvhBuilder::kBinned ? "Binned"
                                                                             : "Spatial") +
             (std::get<1>(info.param) == bvh::BvhCollapse::kArea ? "ByArea" : "ByCost");
    });

TEST_P(SahBvhBuilders, MatchExhaustive) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, 80);
    tests::expect_hits_of_exhaustive(scene, bvh::SahBvh(scene, options()), seed, 200);
  }
}

TEST(SahBvh, EveryInstructionSetGivesTheSameHits) {
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  ASSERT_GE(targets.size(), HWY_ARCH_X86 ? 2U : 1U) << "no choice at run time was compiled in";
  for (const std::int64_t target : targets) {
    SCOPED_TRACE(hwy::TargetName(target));
    const tests::OnlyTarget only(target);
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      SCOPED_TRACE(seed);
      const scenes::Scene scene = tests::random_scene(seed, 80);
      const bvh::SahBvh structure(scene, {});
      ASSERT_STREQ(structure.instruction_set(), hwy::TargetName(target));
      tests::expect_hits_of_exhaustive(scene, structure, seed, 200);
    }
  }
}

TEST(SahBvh, PicksTheBestInstructionSet) {
  const scenes::Scene scene = tests::random_scene(1, 5);
  EXPECT_STREQ(bvh::SahBvh(scene, {}).instruction_set(),
               hwy::TargetName(hwy::SupportedAndGeneratedTargets().front()));
}

// Closed meshes, with rays aimed at their vertices and the middles of their edges.
TEST_P(SahBvhBuilders, LoseNoHitsOnMeshes) {
  for (const char* name : {"bumpy:triangles=3072", "tetra:n=5", "balls:n=3"}) {
    SCOPED_TRACE(name);
    const scenes::Scene scene = scenes::load_scene(name);
    tests::expect_hits_of_exhaustive(scene, bvh::SahBvh(scene, options()), 11, 1500);
  }
}

// Slivers seen from eight scene sizes away, where float tests have the largest errors.
TEST_P(SahBvhBuilders, LoseNoSliverSeenFromAfar) {
  scenes::SceneBuilder builder("slivers");
  Random random(7);
  const auto point = [&] {
    return glm::dvec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
  };
  for (int i = 0; i < 400; ++i) {
    const glm::dvec3 a = point();
    const glm::dvec3 b = a + point() * 0.3;
    builder.add_polygon(std::array<glm::dvec3, 3>{a, b, b + point() * 1e-5});
    builder.add_sphere(point(), 1e-4);
  }
  const scenes::Scene scene = std::move(builder).build();
  const bvh::SahBvh structure(scene, options());
  const exhaustive::Exhaustive exhaustive(scene);
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    Ray ray;
    ray.origin = glm::vec3(glm::normalize(point()) * 24.0);
    const scenes::Primitive& primitive = scene.primitives[random.below(scene.primitives.size())];
    glm::dvec3 target;
    if (primitive.kind == scenes::PrimitiveKind::kSphere) {
      // Aim at the silhouette, where one ray hits and its neighbor does not.
      const glm::dvec3 center(scene.spheres[primitive.index].center);
      const glm::dvec3 beside = glm::cross(center - glm::dvec3(ray.origin), point());
      target = center + glm::normalize(beside) * 1e-4 * random.uniform(0.99, 1.0);
    } else {
      const auto& corner = scene.triangles[scene.polygons[primitive.index].first_triangle].vertex;
      target = glm::mix(glm::dvec3(scene.vertices[corner[0]]),
                        glm::dvec3(scene.vertices[corner[1]]), random.unit());
    }
    ray.direction = glm::vec3(target - glm::dvec3(ray.origin));
    const auto hit = exhaustive.closest_hit(ray, nullptr);
    ASSERT_EQ(structure.closest_hit(ray, nullptr), hit) << i;
    hits += hit ? 1 : 0;
  }
  EXPECT_GT(hits, 1000);
}

/// Checks a child's box against everything below it and counts the nodes.
class WideBvhCheck {
 public:
  WideBvhCheck(const bvh::WideBvh& bvh, const scenes::Scene& scene) : bvh_(bvh), scene_(scene) {}

  void visit(bvh::ChildReference at, const scenes::Bounds& box, std::uint32_t depth) {
    deepest = std::max(deepest, depth);
    if (at.is_leaf()) {
      ++leaves;
      for (std::uint32_t i = 0; i < at.block_count(); ++i) visit(at.first_block() + i, box);
      return;
    }
    const bvh::WideNode& node = bvh_.nodes[at.node_index()];
    EXPECT_GE(node.count(), 2U);
    scenes::Bounds together;
    for (std::uint32_t lane = 0; lane < bvh::kBvhLanes; ++lane) {
      const scenes::Bounds child = box_of(node, lane);
      EXPECT_EQ(child.empty(), lane >= node.count());
      if (lane >= node.count()) continue;
      together.include(child);
      visit(node.children[lane], child, depth + 1);
    }
    if (depth == 1) return;
    EXPECT_EQ(together.lower, box.lower);
    EXPECT_EQ(together.upper, box.upper);
  }

  std::vector<std::uint32_t> triangles_of = std::vector<std::uint32_t>(1'000'000, 0);
  std::uint64_t leaves = 0;
  std::uint64_t pieces = 0;
  std::uint32_t deepest = 0;

 private:
  static scenes::Bounds box_of(const bvh::WideNode& node, std::size_t lane) {
    return {glm::vec3(node.planes[0][lane], node.planes[1][lane], node.planes[2][lane]),
            glm::vec3(node.planes[3][lane], node.planes[4][lane], node.planes[5][lane])};
  }

  void visit(std::uint32_t index, const scenes::Bounds& box) {
    const bvh::PrimitiveBlock& block = bvh_.blocks[index];
    EXPECT_GE(block.count, 1U);
    EXPECT_LE(block.count, bvh::kBvhLanes);
    for (std::uint32_t lane = 0; lane < block.count; ++lane) {
      const scenes::PrimitiveId id = block.primitives[lane];
      ++pieces;
      ++triangles_of[id];
      EXPECT_EQ(scene_.primitives[id].kind, block.kind);
      scenes::Bounds piece = scenes::primitive_bounds(scene_, id);
      if (block.kind == scenes::PrimitiveKind::kPolygon) {
        piece = scenes::Bounds{};
        for (std::size_t corner = 0; corner < 3; ++corner)
          piece.include(block.corner(corner, lane));
      }
      piece = padded(piece, overlap_tolerance(scene_));
      scenes::Bounds both = box;
      both.include(piece);
      EXPECT_EQ(both.lower, box.lower);
      EXPECT_EQ(both.upper, box.upper);
    }
  }

  const bvh::WideBvh& bvh_;
  const scenes::Scene& scene_;
};

TEST(SahBvh, HoldsEveryPrimitiveOnceInBoxesThatFit) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    const scenes::Scene scene = tests::random_scene(seed, static_cast<int>(2 + 10 * seed));
    const bvh::SahBvh structure(scene, {});
    const bvh::WideBvh& bvh = structure.bvh();
    WideBvhCheck check(bvh, scene);
    check.visit(bvh.root, padded(scene.bounds, overlap_tolerance(scene)), 1);
    EXPECT_EQ(check.leaves, bvh.leaves);
    EXPECT_EQ(check.deepest, bvh.depth);
    EXPECT_EQ(check.pieces, bvh.references);
    for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
      const scenes::Primitive& primitive = scene.primitives[id];
      EXPECT_EQ(check.triangles_of[id], primitive.kind == scenes::PrimitiveKind::kPolygon
                                            ? scene.polygons[primitive.index].triangle_count
                                            : 1U);
    }
  }
}

TEST_P(SahBvhBuilders, IsTheSameBuiltInParallel) {
  const scenes::Scene scene = scenes::load_scene("bumpy:triangles=50000");
  bvh::SahBvhOptions with_tasks = options();
  with_tasks.splits.parallel = true;
  const bvh::SahBvh serial(scene, options());
  const bvh::SahBvh parallel(scene, with_tasks);
  ASSERT_EQ(serial.bvh().nodes.size(), parallel.bvh().nodes.size());
  ASSERT_EQ(serial.bvh().blocks.size(), parallel.bvh().blocks.size());
  for (std::size_t i = 0; i < serial.bvh().nodes.size(); ++i) {
    ASSERT_EQ(serial.bvh().nodes[i].planes, parallel.bvh().nodes[i].planes);
  }
  for (std::size_t i = 0; i < serial.bvh().blocks.size(); ++i) {
    ASSERT_EQ(serial.bvh().blocks[i].primitives, parallel.bvh().blocks[i].primitives);
  }
}

TEST(SahBvh, ReportsItsWork) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=3");
  const bvh::SahBvh structure(scene, {});
  const Ray ray = PrimaryRays(scene.cameras.front(), 64, 64, 1).ray(31, 32, 0);
  WorkCounters work;
  const auto hit = structure.closest_hit(ray, &work);
  ASSERT_TRUE(hit);
  const std::vector<TraceStep> steps = structure.path(ray);
  EXPECT_EQ(steps.size(), work.get(Counter::kTraversalSteps));
  std::uint64_t tests = 0;
  bool found = false;
  for (const TraceStep& step : steps) {
    EXPECT_LE(step.t_enter, step.t_exit);
    tests += step.tests.size();
    for (const TestedPrimitive& test : step.tests) {
      found = found || (test.primitive == hit->primitive && test.t == hit->t);
    }
  }
  EXPECT_EQ(tests, work.get(Counter::kPrimitiveTests));
  EXPECT_TRUE(found);
}

// The float tests leave few candidates to the canonical test.
TEST(SahBvh, ConfirmsAboutOncePerHit) {
  const scenes::Scene scene = scenes::load_scene("bumpy:triangles=20000");
  const bvh::SahBvh structure(scene, {});
  WorkCounters work;
  HitBuffer hits(128, 128, 1);
  structure.closest_hits(PrimaryRays(scene.cameras.front(), 128, 128, 1), hits, {&work});
  std::uint64_t hit = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) hit += hits.get(i) ? 1 : 0;
  EXPECT_GE(work.by_name().at("confirmed_tests"), hit);
  EXPECT_LE(work.by_name().at("confirmed_tests"), hit + hit / 10);
}

}  // namespace
}  // namespace beambench::accel

// Quality figures of hierarchies: known values for small ones, and the same model for all
// structures.

#include "accel/core/tree_quality.hpp"

#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <numbers>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/accel/built.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

/// Returns right triangles with legs of 1 in the plane z = 0, their corners at (x, 0).
scenes::Scene triangles_at(std::initializer_list<double> places) {
  scenes::SceneBuilder builder("triangles");
  for (const double x : places) {
    builder.add_polygon(std::array<glm::dvec3, 3>{glm::dvec3(x, 0, 0), glm::dvec3(x + 1, 0, 0),
                                                  glm::dvec3(x, 1, 0)});
  }
  return std::move(builder).build();
}

scenes::Bounds box(float from, float to) { return {glm::vec3(from, 0, 0), glm::vec3(to, 1, 1)}; }

void add_leaf(TreeQuality& tree, const scenes::Bounds& box,
              std::initializer_list<scenes::PrimitiveId> ids) {
  tree.open(box);
  for (const scenes::PrimitiveId id : ids) tree.add_primitive(id);
  tree.close();
}

/// Returns a root with two leaves.
TreeQuality pair_of(const scenes::Bounds& left, const scenes::Bounds& right) {
  TreeQuality tree;
  scenes::Bounds whole = left;
  whole.include(right);
  tree.open(whole);
  add_leaf(tree, left, {0});
  add_leaf(tree, right, {1});
  tree.close();
  return tree;
}

TEST(TreeQuality, DisjointLeavesDoNotOverlap) {
  EXPECT_EQ(pair_of(box(0, 1), box(2, 3)).epo(triangles_at({0, 2})), 0.0);
}

TEST(TreeQuality, WeighsTheAreaInsideOtherLeaves) {
  // The left leaf extends to the middle of the right triangle, 3/8 of which is inside it.
  const scenes::Scene scene = triangles_at({0, 2});
  EXPECT_NEAR(pair_of(box(0, 2.5F), box(2, 3)).epo(scene), 0.375 / 1.0, 1e-12);
}

TEST(TreeQuality, WeighsInteriorNodesByTheirChildren) {
  // The second triangle lies in an interior node with three leaves that do not contain it.
  const scenes::Scene scene = triangles_at({0, 0, 0, 0});
  TreeQuality tree;
  tree.open(box(0, 9));
  tree.open(box(0, 1));
  for (const scenes::PrimitiveId id : {0U, 2U, 3U}) add_leaf(tree, box(5, 6), {id});
  tree.close();
  add_leaf(tree, box(7, 8), {1});
  tree.close();
  EXPECT_NEAR(tree.epo(scene), 3 * 0.6 * 0.25, 1e-12);
}

TEST(TreeQuality, CountsNoOverlapWithANodeThatHoldsAPart) {
  // Divided by a spatial split: the primitive is in both leaves.
  const scenes::Scene scene = triangles_at({0});
  TreeQuality tree;
  tree.open(box(0, 1));
  add_leaf(tree, box(0, 0.5F), {0});
  add_leaf(tree, box(0.5F, 1), {0});
  tree.close();
  EXPECT_EQ(tree.epo(scene), 0.0);
}

TEST(TreeQuality, SamplesPointsOfSolids) {
  scenes::SceneBuilder builder("solids");
  builder.add_sphere(glm::dvec3(0.0), 1.0);
  builder.add_cone(glm::dvec3(0, 0, -1), 2.0, glm::dvec3(0, 0, 3), 0.0);
  const scenes::Scene scene = std::move(builder).build();
  const scenes::Bounds all{glm::vec3(-5.0F), glm::vec3(5.0F)};
  const scenes::Bounds upper{glm::vec3(-5.0F, -5.0F, 0.0F), glm::vec3(5.0F)};
  TreeQuality tree;
  tree.open(all);
  add_leaf(tree, all, {});
  add_leaf(tree, upper, {1});
  add_leaf(tree, upper, {0});
  tree.close();
  // Half of the sphere, and 9/16 of the cone: the part above a quarter of its height.
  const double sphere = 4.0 * std::numbers::pi;
  const double cone = std::numbers::pi * 2.0 * std::sqrt(20.0);
  EXPECT_NEAR(tree.epo(scene), (0.5 * sphere + 0.5625 * cone) / (sphere + cone), 0.01);
}

TEST(TreeQuality, SahCostFollowsTheModel) {
  // A root of 2 x 1 x 1 with half area 5; leaves with half area 3.
  TreeQuality tree;
  tree.open(box(0, 2));
  add_leaf(tree, box(0, 1), {0, 0});
  add_leaf(tree, box(1, 2), {1});
  tree.close();
  EXPECT_NEAR(tree.sah_cost(), 1.2 + (2 + 1) * 3.0 / 5.0, 1e-12);
}

TEST(TreeQuality, SamplesLargeScenes) {
  // 20,000 primitives in a flat tree in which each leaf's box contains its neighbor's triangle.
  scenes::SceneBuilder builder("many");
  constexpr std::uint32_t kMany = 20'000;
  TreeQuality tree;
  tree.open(box(0, 3.0F * kMany));
  for (std::uint32_t i = 0; i < kMany; ++i) {
    const double x = 3.0 * i;
    const double size = i % 2 == 0 ? 1.0 : 0.1;
    builder.add_polygon(std::array<glm::dvec3, 3>{glm::dvec3(x, 0, 0), glm::dvec3(x + size, 0, 0),
                                                  glm::dvec3(x, size, 0)});
    const auto at = static_cast<float>(x);
    add_leaf(tree, box(at, at + 4.5F), {i});
  }
  tree.close();
  const scenes::Scene scene = std::move(builder).build();
  EXPECT_NEAR(tree.epo(scene), 1.0, 0.001);
}

std::map<std::string, double> quality(const std::string& spec, const scenes::Scene& scene) {
  const auto structure = tests::build(spec, scene);
  Statistics statistics;
  append_quality(*structure, scene, statistics);
  return {statistics.more.begin(), statistics.more.end()};
}

TEST(TreeQuality, ExistsOnlyForHierarchiesOfBoxes) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const scenes::Scene scene = tests::random_scene(seed, 60);
    for (const char* spec : {"goldsmith-salmon", "goldsmith-salmon:insert=terminal", "sah-bvh",
                             "sah-bvh:builder=spatial", "tile-beam"}) {
      SCOPED_TRACE(spec);
      const auto figures = quality(spec, scene);
      ASSERT_EQ(figures.size(), 2U);
      EXPECT_GT(figures.at("sah_cost"), 0.0);
      EXPECT_GE(figures.at("epo"), 0.0);
    }
    EXPECT_TRUE(quality("samet", scene).empty());
    EXPECT_TRUE(quality("exhaustive", scene).empty());
  }
  EXPECT_TRUE(quality("sah-bvh", scenes::load_scene("tetra:n=1")).contains("epo"));
}

TEST(TreeQuality, RanksBuilders) {
  const scenes::Scene scene = scenes::load_scene("balls:n=4");
  const auto fast = quality("sah-bvh:builder=lbvh", scene);
  const auto good = quality("sah-bvh:builder=sweep,reinsertion=true", scene);
  EXPECT_LT(good.at("sah_cost"), fast.at("sah_cost"));
  EXPECT_LT(good.at("epo"), fast.at("epo"));
}

}  // namespace
}  // namespace beambench::accel

// The surface area heuristic's estimate: checked by hand, and against traced random lines.

#include "accel/core/expected_visits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "accel/core/work_counters.hpp"
#include "scenes/base/parameters.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::accel {
namespace {

std::map<std::string, double> figures(const Statistics& statistics) {
  return {statistics.more.begin(), statistics.more.end()};
}

TEST(ExpectedVisits, AreSumsOfAreas) {
  ExpectedVisits visits({{0, 0, 0}, {2, 2, 2}});
  visits.add_node(scenes::Bounds{{-1, -1, -1}, {3, 3, 3}});  // only the part inside the scene's box
  visits.add_leaf(scenes::Bounds{{0, 0, 0}, {1, 1, 1}}, 3);
  visits.add_leaf(scenes::Bounds{{4, 4, 4}, {5, 5, 5}}, 3);
  Statistics statistics;
  visits.append_to(statistics);
  EXPECT_EQ(figures(statistics),
            (std::map<std::string, double>{
                {"sah_nodes", 1.0}, {"sah_leaves", 0.25}, {"sah_tests", 0.75}}));
}

TEST(ExpectedVisits, AreUnknownForAFlatSceneWithoutArea) {
  Statistics statistics;
  ExpectedVisits({{0, 0, 0}, {1, 0, 0}}).append_to(statistics);
  EXPECT_TRUE(statistics.more.empty());
}

/// Returns a line through two random points of a sphere around the scene; such lines are uniformly
/// distributed.
Ray random_line(const glm::dvec3& center, double radius, Random& random) {
  const auto on_sphere = [&] {
    const double z = random.uniform(-1.0, 1.0);
    const double angle = random.uniform(0.0, 6.283185307179586);
    const double beside = std::sqrt(1.0 - z * z);
    return center + radius * glm::dvec3(beside * std::cos(angle), beside * std::sin(angle), z);
  };
  Ray ray;
  const glm::dvec3 from = on_sphere();
  ray.origin = glm::vec3(from);
  ray.direction = glm::vec3(on_sphere() - from);
  return ray;
}

/// Triangles so small that lines hardly ever hit one: lines without hits visit every node that they
/// intersect.
scenes::Scene small_triangles() {
  scenes::SceneBuilder builder("small triangles");
  Random random(9);
  for (int i = 0; i < 1500; ++i) {
    const glm::dvec3 a{random.unit(), 2.0 * random.unit(), random.unit()};
    builder.add_polygon(
        std::array<glm::dvec3, 3>{a, a + glm::dvec3(0.01, 0, 0), a + glm::dvec3(0, 0.01, 0.01)});
  }
  return std::move(builder).build();
}

class EstimatedStructure : public ::testing::TestWithParam<const char*> {};

TEST_P(EstimatedStructure, EstimatesWhatLinesThatMissVisit) {
  const scenes::Scene scene = small_triangles();
  const auto structure = registry().choose(parse_spec(GetParam())).build(scene);
  const auto estimate = figures(structure->statistics());
  const glm::dvec3 lower(scene.bounds.lower);
  const glm::dvec3 upper(scene.bounds.upper);
  Random random(3);
  WorkCounters work;
  double lines = 0;
  for (int i = 0; i < 60'000; ++i) {
    const Ray ray = random_line((lower + upper) * 0.5, glm::length(upper - lower) * 0.5, random);
    const glm::dvec3 inverse = 1.0 / glm::dvec3(ray.direction);
    const glm::dvec3 a = (lower - glm::dvec3(ray.origin)) * inverse;
    const glm::dvec3 b = (upper - glm::dvec3(ray.origin)) * inverse;
    const glm::dvec3 near = glm::min(a, b);
    const glm::dvec3 far = glm::max(a, b);
    const bool meets_box = std::max({near.x, near.y, near.z}) <= std::min({far.x, far.y, far.z});
    if (!meets_box || structure->any_hit(ray, nullptr)) continue;
    lines += 1.0;
    structure->closest_hit(ray, &work);
  }
  ASSERT_GT(lines, 10'000);
  const double leaves = static_cast<double>(work.get(Counter::kLeaves)) / lines;
  const double steps = static_cast<double>(work.get(Counter::kTraversalSteps)) / lines;
  EXPECT_NEAR(leaves, estimate.at("sah_leaves"), 0.05 * leaves);
  const std::string name = GetParam();
  if (name == "sah-bvh" || name == "kd-tree") {  // all other steps are interior nodes
    EXPECT_NEAR(steps - leaves, estimate.at("sah_nodes"), 0.05 * (steps - leaves));
  }
}
INSTANTIATE_TEST_SUITE_P(All, EstimatedStructure,
                         ::testing::Values("sah-bvh", "kd-tree", "samet:root=box",
                                           "hierarchical-grid"));

TEST(TestsByKind, AddUpToThePrimitiveTests) {
  const scenes::Scene scene = scenes::load_scene("rings:n=2");
  Random random(5);
  for (const char* name : {"exhaustive", "samet", "samet-net", "voxel-grid", "hierarchical-grid",
                           "goldsmith-salmon", "sah-bvh", "kd-tree", "beam", "tile-beam"}) {
    SCOPED_TRACE(name);
    const auto structure = registry().choose(parse_spec(name)).build(scene);
    WorkCounters work;
    for (int i = 0; i < 500; ++i) {
      const Ray ray = random_line(glm::dvec3(scene.bounds.lower + scene.bounds.upper) * 0.5,
                                  glm::length(glm::dvec3(scene.bounds.extent())) * 0.5, random);
      structure->closest_hit(ray, &work);
      structure->any_hit(ray, &work);
    }
    const auto counts = work.by_name();
    ASSERT_TRUE(counts.contains("sphere_tests"));
    EXPECT_GT(counts.at("sphere_tests"), 0U);
    EXPECT_GT(counts.at("cone_tests"), 0U);
    EXPECT_EQ(counts.at("sphere_tests") + counts.at("cone_tests") + counts.at("polygon_tests"),
              counts.at("primitive_tests"));
  }
}

TEST(TestsByKind, AreNotReportedIfAStructureDoesNotSplitThem) {
  WorkCounters work;
  work.add_tests(scenes::PrimitiveKind::kCone, 2);
  EXPECT_EQ(work.by_name().at("cone_tests"), 2U);
  work.add(Counter::kPrimitiveTests);
  EXPECT_FALSE(work.by_name().contains("cone_tests"));
}

}  // namespace
}  // namespace beambench::accel

// Work that an image costs in the hierarchies: a tree or a traversal that gets worse fails here
// even when its hits stay right. Better is fine, once: then pin the new figures.

#include <gtest/gtest.h>

#include "accel/registry.hpp"
#include "scenes/catalogue.hpp"

namespace beambench {
namespace {

struct Work {
  const char* structure;
  const char* scene;
  std::uint64_t steps, box_tests, primitive_tests;
};

class BvhWork : public ::testing::TestWithParam<Work> {};

TEST_P(BvhWork, IsPinned) {
  const Work& expected = GetParam();
  const Scene scene = load_scene(expected.scene);
  const auto structure = registry().choose(parse_spec(expected.structure)).build(scene);
  HitBuffer buffer(64, 64, 1);
  WorkCounters counters;
  structure->trace(PrimaryRays(scene.cameras.front(), 64, 64, 1), buffer, counters);
  EXPECT_EQ(counters.get(Counter::kTraversalSteps), expected.steps);
  EXPECT_EQ(counters.get(Counter::kBoxTests), expected.box_tests);
  EXPECT_EQ(counters.get(Counter::kPrimitiveTests), expected.primitive_tests);
}

INSTANTIATE_TEST_SUITE_P(
    All, BvhWork,
    ::testing::Values(Work{"goldsmith-salmon", "tetra:n=6", 32'328, 103'576, 6'184},
                      Work{"goldsmith-salmon", "balls:n=4", 29'864, 84'360, 5'392},
                      Work{"goldsmith-salmon", "escena1", 29'116, 81'281, 3'579},
                      Work{"goldsmith-salmon:order=shuffled", "escena1", 30'569, 88'921, 3'579},
                      Work{"goldsmith-salmon:queue=stack", "escena1", 29'368, 81'941, 3'693},
                      Work{"sah-bvh", "tetra:n=6", 10'486, 68'080, 15'808},
                      Work{"sah-bvh", "balls:n=4", 20'028, 100'175, 27'963},
                      Work{"sah-bvh", "escena1", 13'234, 58'338, 42'366}),
    [](const auto& info) {
      std::string name = std::string(info.param.structure) + '_' + info.param.scene;
      std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
      return name;
    });

}  // namespace
}  // namespace beambench

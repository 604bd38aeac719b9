// Tests of samples in the leaves of beams: all modes find the same hits, and only the mode that
// uses SIMD states an instruction set.

#include <array>
#include <cstdint>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "harness/verify/selftest/test_scenes.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

class LeafTests : public ::testing::TestWithParam<std::string> {
 protected:
  /// Returns the structure with `leaf` and other parameters.
  static StructureChoice with(const std::string& leaf, const std::string& others = "") {
    return registry().choose(parse_spec(fmt::format("{}:leaf={}{}", GetParam(), leaf, others)));
  }
};

/// Traces an image, expects the hits of exhaustive search, and returns the number of tests.
std::uint64_t tests_of(const StructureChoice& choice, const scenes::Scene& scene,
                       const PrimaryRays& rays, const HitBuffer& expected) {
  HitBuffer hits(rays.width(), rays.height(), rays.samples());
  WorkCounters counters;
  choice.build(scene)->closest_hits(rays, hits, {&counters});
  EXPECT_EQ(hits, expected) << choice.short_label();
  return counters.get(Counter::kPrimitiveTests);
}

TEST_P(LeafTests, MatchExhaustiveAndRejectEqually) {
  std::uint64_t rejected = 0;
  for (std::uint64_t seed = 1; seed <= 120 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    const scenes::Scene scene = tests::random_scene(seed, static_cast<int>(1 + random.below(60)));
    const PrimaryRays rays(
        verify::random_camera(scene, random), 1 + static_cast<int>(random.below(40)),
        1 + static_cast<int>(random.below(40)), std::array{1, 4, 5}[random.below(3)]);
    const std::string others = fmt::format(
        ",max_level={},continue={},share_corners={},handover={}", 1 + random.below(4),
        random.below(2) == 0 ? "rays" : "beams", random.below(2) == 0, random.below(2) * 20);
    HitBuffer expected(rays.width(), rays.height(), rays.samples());
    registry().choose({"exhaustive", {}}).build(scene)->closest_hits(rays, expected, {});
    const std::uint64_t simd = tests_of(with("simd", others), scene, rays, expected);
    const std::uint64_t scalar = tests_of(with("scalar", others), scene, rays, expected);
    const std::uint64_t exact = tests_of(with("exact", others), scene, rays, expected);
    EXPECT_EQ(scalar, simd);
    EXPECT_GE(exact, scalar);
    rejected += exact - scalar;
  }
  EXPECT_GT(rejected, 10'000U);
}

TEST_P(LeafTests, StateTheirInstructionSet) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=2");
  const auto stated = [&](const std::string& leaf) {
    return with(leaf).build(scene)->statistics().instruction_set;
  };
  EXPECT_NE(stated("simd"), "");
  EXPECT_EQ(stated("scalar"), "");
  EXPECT_EQ(stated("exact"), "");
}

std::string name_of_case(const ::testing::TestParamInfo<std::string>& info) {
  return info.param == "beam" ? "beam" : "grid_beam";
}

INSTANTIATE_TEST_SUITE_P(All, LeafTests, ::testing::Values("beam", "grid-beam"), name_of_case);

TEST(InstructionSets, AreStatedIfQueriesUseSimd) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=2");
  for (const char* scalar : {"exhaustive", "samet", "samet-net", "glassner", "gargantini",
                             "voxel-grid", "hierarchical-grid", "goldsmith-salmon", "null"}) {
    EXPECT_EQ(registry().choose({scalar, {}}).build(scene)->statistics().instruction_set, "")
        << scalar;
  }
  for (const char* simd : {"sah-bvh", "kd-tree", "beam", "grid-beam", "embree", "tile-beam"}) {
    EXPECT_NE(registry().choose({simd, {}}).build(scene)->statistics().instruction_set, "") << simd;
  }
}

}  // namespace
}  // namespace beambench::accel

// Properties of every structure in the registry: registering a new one is enough to test it.

#include <algorithm>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "harness/verify/selftest/selftest.hpp"
#include "tests/number_from.hpp"
#include "tests/random_scene.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::accel {
namespace {

/// A check of the self-test, and the structure to which it is applied.
struct CheckOfStructure {
  std::string structure;
  const verify::Check* check;
};

void PrintTo(const CheckOfStructure& parameter, std::ostream* stream) {
  *stream << parameter.structure << ": " << parameter.check->claim;
}

std::vector<CheckOfStructure> all_checks() {
  std::vector<CheckOfStructure> all;
  for (const StructureInfo& info : registry().structures()) {
    const verify::Subject subject(registry().choose({info.name, {}}));
    for (const verify::Check& check : verify::selftest_checks()) {
      if (verify::applies(check, subject)) all.push_back({info.name, &check});
    }
  }
  return all;
}

std::string name_of_check(const ::testing::TestParamInfo<CheckOfStructure>& info) {
  std::string name = info.param.structure + ' ' + std::string(info.param.check->name);
  std::erase(name, ',');
  std::ranges::replace(name, '-', '_');
  std::ranges::replace(name, ' ', '_');
  return name;
}

class Contract : public ::testing::TestWithParam<CheckOfStructure> {};

/// Returns the number of random scenes of each check: more than in `beambench selftest`. Builds
/// with sanitizers use few scenes, which reveal just as much (.ci/run).
std::uint64_t random_scenes() {
  return tests::number_from("BEAMBENCH_CONTRACT_SCENES", tests::in_full(240, 80));
}

TEST_P(Contract, IsKept) {
  const verify::SelftestEffort effort{.seed = 1, .scenes = random_scenes()};
  const verify::Subject subject(registry().choose({GetParam().structure, {}}));
  const verify::CheckOutcome outcome = verify::run_check(*GetParam().check, subject, effort);
  EXPECT_EQ(outcome.failure, "");
}

INSTANTIATE_TEST_SUITE_P(All, Contract, ::testing::ValuesIn(all_checks()), name_of_check);

TEST(Registry, NamesTheValidStructures) {
  const std::string message =
      scenes::thrown_message([] { registry().choose(parse_spec("sammet:max_level=5")); });
  EXPECT_TRUE(scenes::says(message, {"'sammet'", "did you mean 'samet'", "exhaustive"}));
}

TEST(Registry, EveryStructureIsDescribed) {
  for (const auto& info : registry().structures()) {
    EXPECT_FALSE(info.summary.empty()) << info.name;
    for (const auto& parameter : info.parameters) {
      EXPECT_FALSE(parameter.description.empty()) << info.name << ' ' << parameter.name;
    }
  }
}

TEST(Null, HitsNothing) {
  const scenes::Scene scene = tests::random_scene(3, 10);
  const auto null = registry().choose({"null", {}}).build(scene);
  HitBuffer buffer(8, 8, 1);
  null->closest_hits(PrimaryRays(scene.cameras.front(), 8, 8, 1), buffer, {});
  EXPECT_EQ(buffer, HitBuffer(8, 8, 1));
  const std::vector<Ray> rays(3);
  HitBuffer closest(3, 1, 1);
  std::vector<std::uint8_t> any(3, 0xFF);
  null->closest_hits(accel::RayBatch{rays}, closest, {});
  null->any_hits(accel::RayBatch{rays}, any, {});
  EXPECT_EQ(closest, HitBuffer(3, 1, 1));
  EXPECT_EQ(any, (std::vector<std::uint8_t>(3, 0)));
}

}  // namespace
}  // namespace beambench::accel

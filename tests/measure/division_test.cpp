// The division of a sweep: every group is entirely in one shard, and the work is divided evenly.

#include "harness/measure/division.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "accel/core/registry.hpp"
#include "harness/measure/config.hpp"
#include "harness/measure/plan.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::measure {
namespace {

SweepConfig sweep() {
  return parse_sweep({{"name", "test"},
                      {"scenes", {"tetra:n=1", "tetra:n=4", "balls:n=2"}},
                      {"structures", {"null", "exhaustive", "samet", "embree"}},
                      {"resolutions", {"32x20", "64x48", "320x200"}},
                      {"rays", {"primary", "shadow", "ao"}},
                      {"budget_seconds", 10}},
                     "test", accel::registry());
}

std::vector<std::string> cell_names(const Plan& plan) {
  std::vector<std::string> names;
  for (const CellGroup& group : plan.groups) {
    for (const PlannedCell& cell : group.cells) names.push_back(cell.id.name());
  }
  return names;
}

class Divided : public testing::TestWithParam<int> {};

TEST_P(Divided, EveryCellIsInOneShardAndGroupsAreWhole) {
  const SweepConfig config = sweep();
  const Plan whole = make_plan(config);
  std::map<std::string, std::size_t> indices;
  std::multiset<std::string> wanted, found;
  for (const CellGroup& group : whole.groups) {
    for (const PlannedCell& cell : group.cells) indices[cell.id.name()] = cell.index;
  }
  const std::vector<std::string> names = cell_names(whole);
  wanted.insert(names.begin(), names.end());
  std::set<std::string> groups;
  for (int number = 1; number <= GetParam(); ++number) {
    Plan plan = make_plan(config);
    const PlannedShard shard = keep_shard(plan, config, {number, GetParam()});
    EXPECT_EQ(shard.facts.cells, plan.cell_count());
    EXPECT_EQ(shard.facts.cells_of_sweep, whole.cell_count());
    EXPECT_EQ(shard.scenes.size(), 3U) << "scenes of the other shards, too";
    const std::vector<std::string> own = cell_names(plan);
    found.insert(own.begin(), own.end());
    for (const CellGroup& group : plan.groups) {
      EXPECT_TRUE(groups.insert(group.name()).second) << group.name();
      for (const PlannedCell& cell : group.cells) {
        EXPECT_EQ(cell.index, indices.at(cell.id.name())) << "its place in the whole sweep";
      }
    }
  }
  EXPECT_EQ(found, wanted);
}

/// Returns the largest share of the estimated work among `count` shards.
double largest_share(const SweepConfig& config, int count) {
  double most = 0.0;
  for (int number = 1; number <= count; ++number) {
    Plan plan = make_plan(config);
    most = std::max(most, keep_shard(plan, config, {number, count}).share);
  }
  return most;
}

TEST_P(Divided, TheEstimatedWorkIsEven) {
  const SweepConfig config = sweep();
  double sum = 0.0;
  for (int number = 1; number <= GetParam(); ++number) {
    Plan plan = make_plan(config);
    sum += keep_shard(plan, config, {number, GetParam()}).share;
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
  // The optimum is at least an even share, and at least the share of the largest group. Assigning
  // the most expensive group first exceeds the optimum by at most a third (Graham 1969).
  const double group = largest_share(config, static_cast<int>(make_plan(config).groups.size()));
  EXPECT_LE(largest_share(config, GetParam()), 4.0 / 3.0 * std::max(1.0 / GetParam(), group));
}

INSTANTIATE_TEST_SUITE_P(Shards, Divided, testing::Values(1, 2, 4, 7));

TEST(Division, OneShardIsTheWholeSweep) {
  const SweepConfig config = sweep();
  const Plan whole = make_plan(config);
  Plan plan = make_plan(config);
  keep_shard(plan, config, {1, 1});
  EXPECT_EQ(cell_names(plan), cell_names(whole));
}

TEST(Division, MoreShardsThanGroupsAreRefused) {
  const SweepConfig config = sweep();
  const std::string message = scenes::thrown_message([&] {
    Plan plan = make_plan(config);
    const int groups = static_cast<int>(plan.groups.size());
    keep_shard(plan, config, {1, groups + 1});
  });
  EXPECT_TRUE(scenes::says(message, {"--shard 1/", "groups", "divide it into at most"}));
}

TEST(Shard, IsReadAndWritten) {
  EXPECT_EQ(parse_shard("2/4"), (Shard{2, 4}));
  EXPECT_EQ(parse_shard("1/1"), (Shard{1, 1}));
  EXPECT_EQ(to_string(Shard{2, 4}), "2/4");
}

TEST(Shard, InvalidShardsAreRefused) {
  for (const char* text : {"", "/", "2", "0/4", "5/4", "-1/4", "1/0", "1/-4", "1/4/2", "1/4 ",
                           " 1/4", "a/b", "1.5/4", "99999999999/99999999999"}) {
    EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { parse_shard(text); }),
                             {"--shard", "K/N with K from 1 to N", std::string(text)}))
        << text;
  }
}

}  // namespace
}  // namespace beambench::measure

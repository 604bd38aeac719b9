// Who is fastest: ties, ratios round by round, references, reasons, break-even, means.

#include "harness/bench/standings.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace beambench::bench {
namespace {

using Json = nlohmann::ordered_json;

struct Contender {
  std::string structure;
  std::vector<double> trace_ms;  // of each round
  double build_ms = 1.0;
  std::string parameters{};
  std::string verdict = "ok";
};

/// A cell's file with what standings read.
Json cell_of(const Contender& contender, const std::string& scene = "escena1",
             std::uint64_t rays = 1000) {
  const bool timed = !contender.trace_ms.empty();
  Json repetitions = Json::array();
  for (std::size_t i = 0; i < contender.trace_ms.size(); ++i) {
    repetitions.push_back({{"round", i}, {"trace_ms", contender.trace_ms[i]}});
  }
  const auto interval = median_interval(contender.trace_ms);
  const Json row{{"scene", scene},
                 {"camera", "default"},
                 {"structure", contender.structure},
                 {"parameters", contender.parameters},
                 {"width", rays / 10},
                 {"height", 10},
                 {"samples", 1},
                 {"ray_kind", "primary"},
                 {"rays", rays},
                 {"primitives", 400},
                 {"build_ms_median", timed ? Json(contender.build_ms) : Json()},
                 {"trace_ms_median", timed ? Json(median(contender.trace_ms)) : Json()},
                 {"trace_ms_ci_low", interval ? Json(interval->low) : Json()},
                 {"trace_ms_ci_high", interval ? Json(interval->high) : Json()},
                 {"verdict", contender.verdict}};
  return {{"key", scene + contender.structure + contender.parameters + fmt::to_string(rays)},
          {"row", row},
          {"message", timed ? "" : "two hits are wrong"},
          {"repetitions", repetitions}};
}

std::vector<double> rounds(double ms) {
  return {ms, ms * 1.01, ms * 0.99, ms, ms * 1.02, ms, ms, ms * 0.98};
}

TEST(Standings, TheFastestContenderLeadsWhateverTheOrderOfTheCells) {
  const std::vector<Json> cells{cell_of({"samet", rounds(4.0)}), cell_of({"embree", rounds(2.0)}),
                                cell_of({"tile-beam", rounds(1.0)})};
  const Standings view = standings(cells, {}).at(0);
  ASSERT_EQ(view.ranked.size(), 3U);
  EXPECT_EQ(view.ranked[0].contender, "tile-beam");
  EXPECT_EQ(view.ranked[0].ratio.value, 1.0);
  EXPECT_DOUBLE_EQ(view.ranked[0].ns_per_ray, 1000.0);
  EXPECT_EQ(view.behind()->contender, "embree");
  EXPECT_NEAR(view.embree()->ratio.value, 2.0, 1e-12);
}

TEST(Standings, RatiosArePairedRoundByRound) {
  // Both are twice as slow in half of the rounds: the ratio does not see it.
  const std::vector<double> slow_machine{1, 2, 1, 2, 1, 2, 1, 2};
  std::vector<double> other;
  for (const double ms : slow_machine) other.push_back(1.1 * ms);
  const std::vector<Json> cells{cell_of({"samet", other}), cell_of({"embree", slow_machine})};
  const Standing behind = *standings(cells, {}).at(0).behind();
  EXPECT_NEAR(behind.ratio.value, 1.1, 1e-12);
  EXPECT_NEAR(behind.ratio.interval->low, 1.1, 1e-12);
  EXPECT_NEAR(behind.ratio.interval->high, 1.1, 1e-12);
}

TEST(Standings, WhatTheNoiseHidesIsATie) {
  const std::vector<Json> cells{cell_of({"samet", {1.0, 1.2, 0.9, 1.1, 1.0, 1.3, 0.8, 1.05}}),
                                cell_of({"embree", {1.1, 1.0, 1.0, 1.0, 1.2, 1.0, 1.1, 1.0}})};
  const std::vector<Standings> views = standings(cells, {});
  EXPECT_EQ(views[0].behind(), nullptr);
  EXPECT_FALSE(views[0].break_even_rays());
  EXPECT_NE(describe(views).find("tie: "), std::string::npos);
}

TEST(Standings, FewRoundsDecideNothingAndAreNoTieEither) {
  const std::vector<Json> cells{cell_of({"samet", {1.0, 1.0, 1.0}}),
                                cell_of({"embree", {2.0, 2.0, 2.0}})};
  const Standings view = standings(cells, {}).at(0);
  EXPECT_FALSE(view.ranked[1].ratio.interval);
  EXPECT_FALSE(view.ranked[1].is_tied());
}

TEST(Standings, NullAndExhaustiveAreReferencesAndNeverWin) {
  const std::vector<Json> cells{cell_of({"null", rounds(0.1), 0.0, "", "baseline"}),
                                cell_of({"exhaustive", rounds(0.2)}),
                                cell_of({"samet", rounds(1.0)})};
  const Standings view = standings(cells, {}).at(0);
  ASSERT_EQ(view.ranked.size(), 1U);
  EXPECT_EQ(view.ranked[0].contender, "samet");
  EXPECT_EQ(view.references.size(), 2U);
}

TEST(Standings, WhoHasNoTimeIsListedWithTheReason) {
  const std::vector<Json> cells{cell_of({"samet", rounds(1.0)}),
                                cell_of({"embree", {}, 0.0, "", "mismatch"}),
                                cell_of({"exhaustive", rounds(9.0)}, "escena1", 100),
                                cell_of({"beam", rounds(2)}, "escena2")};
  Exclusion large;
  large.structure = "exhaustive";
  large.rays_above = 500;
  const std::vector<Exclusion> exclude{large};
  const Standings view = standings(cells, exclude).at(0);
  ASSERT_EQ(view.left_out.size(), 3U);
  EXPECT_EQ(view.left_out[0].contender, "beam");
  EXPECT_EQ(view.left_out[0].reason, "not in the record");
  EXPECT_EQ(view.left_out[1].reason, "mismatch: two hits are wrong");
  EXPECT_EQ(view.left_out[2].reason, "left out by the sweep (more than 500 rays)");
}

TEST(Standings, ContendersAreNamedByTheParametersThatDiffer) {
  const std::vector<Json> cells{cell_of({"samet", rounds(1.0), 1.0, "max_level=6,root=cube"}),
                                cell_of({"samet", rounds(2.0), 1.0, "max_level=7,root=cube"}),
                                cell_of({"embree", rounds(3.0), 1.0, "mode=single"})};
  const Standings view = standings(cells, {}).at(0);
  EXPECT_EQ(view.ranked[0].contender, "samet max_level=6");
  EXPECT_EQ(view.ranked[2].contender, "embree");
}

TEST(Standings, TheBuildPaysOffWhereTheLinesCross) {
  // 3 ms more to build, 1 ms less for each thousand rays.
  const std::vector<Json> cells{cell_of({"samet", rounds(1.0), 4.0}),
                                cell_of({"embree", rounds(2.0), 1.0})};
  EXPECT_NEAR(*standings(cells, {}).at(0).break_even_rays(), 3000.0, 1e-6);
  const std::vector<Json> cheap{cell_of({"samet", rounds(1.0), 0.5}),
                                cell_of({"embree", rounds(2.0), 1.0})};
  EXPECT_EQ(*standings(cheap, {}).at(0).break_even_rays(), 0.0);
}

TEST(Standings, MeansAreGeometricAndCountVictories) {
  const std::vector<Json> cells{
      cell_of({"samet", rounds(1.0)}, "escena1"), cell_of({"embree", rounds(2.0)}, "escena1"),
      cell_of({"samet", rounds(8.0)}, "escena2"), cell_of({"embree", rounds(1.0)}, "escena2")};
  const auto views = standings(cells, {});
  const OverallStandings all = overall(views).at(0);
  ASSERT_EQ(all.means.size(), 2U);
  EXPECT_EQ(all.means[0].contender, "embree");
  EXPECT_NEAR(all.means[0].ratio.value, std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(all.means[1].ratio.value, std::sqrt(8.0), 1e-9);
  EXPECT_EQ(all.means[0].wins, 1);
  EXPECT_EQ(all.views, 2);
}

Json on_machine(Json cell, const std::string& machine) {
  cell["row"]["machine_id"] = machine;
  return cell;
}

TEST(Standings, TimesOfTwoMachinesAreNotCompared) {
  // At 1000 rays one machine, at 4000 another, where the order is the other one.
  const std::vector<Json> cells{
      on_machine(cell_of({"samet", rounds(1.0)}), "0123456789abcdef"),
      on_machine(cell_of({"embree", rounds(2.0)}), "0123456789abcdef"),
      on_machine(cell_of({"samet", rounds(9.0)}, "escena1", 4000), "fedcba9876543210"),
      on_machine(cell_of({"embree", rounds(3.0)}, "escena1", 4000), "fedcba9876543210")};
  const auto views = standings(cells, {});
  ASSERT_EQ(views.size(), 2U);
  EXPECT_EQ(views[0].view, "escena1, machine 01234567");
  EXPECT_NEAR(views[0].behind()->ratio.value, 2.0, 1e-12);
  EXPECT_EQ(views[1].view, "escena1, machine fedcba98");
  EXPECT_NEAR(views[1].behind()->ratio.value, 3.0, 1e-12);
  EXPECT_EQ(views[0].subject, "escena1");
  EXPECT_EQ(views[1].subject, "escena1");
  // Means are over the highest resolution of each view, as in a run on one machine.
  const OverallStandings all = overall(views).at(0);
  EXPECT_EQ(all.views, 1);
  EXPECT_EQ(all.means[0].contender, "embree");
}

TEST(Standings, AViewWithoutTimesSaysSo) {
  const std::vector<Json> cells{cell_of({"samet", {}, 0.0, "", "error"})};
  const auto views = standings(cells, {});
  EXPECT_TRUE(views[0].ranked.empty());
  EXPECT_NE(describe(views).find("no contender has a time"), std::string::npos);
  EXPECT_NE(describe_contenders(views).find("error: two hits are wrong"), std::string::npos);
}

}  // namespace
}  // namespace beambench::bench

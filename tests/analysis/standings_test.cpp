// Rankings: ties, ratios round by round, references, reasons, break-even, means.

#include "harness/analysis/standings.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "harness/analysis/words.hpp"
#include "harness/plugin/program_contender.hpp"
#include "tests/analysis/some_run.hpp"

namespace beambench::analysis {
namespace {

using measure::CellRecord;
using verify::Verdict;

TEST(Standings, TheFastestContenderLeadsWhateverTheOrderOfTheCells) {
  const std::vector<CellRecord> cells{cell_of({"samet", rounds(4.0)}),
                                      cell_of({"embree", rounds(2.0)}),
                                      cell_of({"tile-beam", rounds(1.0)})};
  const Standings view = standings(run_of(cells)).at(0);
  ASSERT_EQ(view.ranked.size(), 3U);
  EXPECT_EQ(view.ranked[0].contender, "tile-beam");
  EXPECT_EQ(view.ranked[0].ratio.value, 1.0);
  EXPECT_NEAR(view.ranked[0].ns_per_ray, 1000.0, 0.2);
  EXPECT_EQ(view.behind()->contender, "embree");
  EXPECT_NEAR(view.embree()->ratio.value, 2.0, 1e-12);
}

TEST(Standings, RatiosArePairedBlockByBlock) {
  // Both are twice as slow in half of the blocks, which does not affect the ratio.
  const std::vector<double> slow_machine{1, 2, 1, 2, 1, 2, 1, 2};
  std::vector<double> other;
  for (const double ms : slow_machine) other.push_back(1.1 * ms);
  const std::vector<CellRecord> cells{cell_of({"samet", other}), cell_of({"embree", slow_machine})};
  const Standing behind = *standings(run_of(cells)).at(0).behind();
  EXPECT_NEAR(behind.ratio.value, 1.1, 1e-12);
  EXPECT_NEAR(behind.ratio.interval->low, 1.1, 1e-12);
  EXPECT_NEAR(behind.ratio.interval->high, 1.1, 1e-12);
}

TEST(BlockTotals, UseTheClockCommonToAllContenders) {
  std::vector<CellRecord> cells{cell_of({"samet", {1.0, 2.0}, 0.5}),
                                cell_of({"embree", {3.0, 4.0}}),
                                cell_of({"null", {}, 1.0, "", Verdict::kMismatch})};
  const std::vector<BlockTotals> totals = block_totals(run_of(cells));
  ASSERT_EQ(totals.size(), 2U);
  EXPECT_EQ(totals[0].cell, "escena1/default/100x10/1/primary/samet");
  EXPECT_EQ(totals[0].ms, (TimesByBlock{{0, 1.5}, {1, 2.5}}));
  for (measure::Repetition& one : cells[1].repetitions) one.trace_ms *= 2.0;  // waited
  const std::vector<BlockTotals> disturbed = block_totals(run_of(cells));
  EXPECT_EQ(disturbed[0].clock, measure::TraceClock::kCpu);
  EXPECT_EQ(disturbed[0].ms, (TimesByBlock{{0, 1.0}, {1, 2.0}})) << "its builds have no CPU time";
  EXPECT_EQ(disturbed[1].ms, (TimesByBlock{{0, 3.0}, {1, 4.0}}));
  cells[0] = of_one_process(cells[0]);
  EXPECT_EQ(block_totals(run_of(cells)).size(), 1U);
}

TEST(Standings, DifferencesBelowTheNoiseAreUndecided) {
  const std::vector<CellRecord> cells{
      cell_of({"samet", {1.0, 1.2, 0.9, 1.1, 1.0, 1.3, 0.8, 1.05}}),
      cell_of({"embree", {1.1, 1.0, 1.0, 1.0, 1.2, 1.0, 1.1, 1.0}})};
  const std::vector<Standings> views = standings(run_of(cells));
  EXPECT_EQ(views[0].behind(), nullptr);
  EXPECT_FALSE(views[0].break_even_rays());
  EXPECT_EQ(views[0].ranked[1].rank(), Rank::kUndecided);
  EXPECT_NE(describe(views).find("undecided: "), std::string::npos);
}

/// Equivalent means that the whole interval is within the margin of 3%, whether or not it contains
/// 1.
TEST(Standings, DifferencesWithinTheMarginAreTies) {
  const auto rank_of = [](double factor) {
    const std::vector<CellRecord> cells{cell_of({"samet", rounds(1.0)}),
                                        cell_of({"embree", rounds(factor)})};
    return standings(run_of(cells)).at(0).ranked.at(1).rank();
  };
  EXPECT_EQ(rank_of(1.02), Rank::kTied);
  EXPECT_EQ(rank_of(1.04), Rank::kBehind);
}

TEST(Standings, OneBlockDecidesNothingNotEvenATie) {
  const std::vector<CellRecord> cells{cell_of({"samet", {1.0}}), cell_of({"embree", {2.0}})};
  const Standings view = standings(run_of(cells)).at(0);
  EXPECT_FALSE(view.ranked[1].ratio.interval);
  EXPECT_EQ(view.ranked[1].rank(), Rank::kUnranked);
}

TEST(Standings, MeansExcludeViewsWithHardlyAnyHits) {
  std::vector<CellRecord> cells{cell_of({"samet", rounds(1.0)}), cell_of({"embree", rounds(2.0)}),
                                cell_of({"samet", rounds(1.0)}, "escena2"),
                                cell_of({"embree", rounds(2.0)}, "escena2")};
  for (std::size_t i : {2U, 3U}) cells[i].rays.hit_share = 0.005;
  EXPECT_EQ(overall(standings(run_of(cells))).at(0).views, 1);
  for (std::size_t i : {2U, 3U}) {
    cells[i].rays.hit_share.reset();
    cells[i].rays.occluded_share = 0.995;
  }
  EXPECT_EQ(overall(standings(run_of(cells))).at(0).views, 1);
  for (std::size_t i : {2U, 3U}) cells[i].rays.occluded_share = 0.5;
  EXPECT_EQ(overall(standings(run_of(cells))).at(0).views, 2);
}

TEST(Standings, NullAndExhaustiveAreReferencesAndNeverWin) {
  const std::vector<CellRecord> cells{cell_of({"null", rounds(0.1), 0.0, "", Verdict::kBaseline}),
                                      cell_of({"exhaustive", rounds(0.2)}),
                                      cell_of({"samet", rounds(1.0)})};
  const Standings view = standings(run_of(cells)).at(0);
  ASSERT_EQ(view.ranked.size(), 1U);
  EXPECT_EQ(view.ranked[0].contender, "samet");
  EXPECT_EQ(view.references.size(), 2U);
}

TEST(Standings, TimesOfAProgramsOwnClockAreMarked) {
  std::vector<CellRecord> cells{cell_of({"samet", rounds(1.0)}), cell_of({"mine", rounds(2.0)})};
  for (CellRecord& cell : cells) cell.statistics.emplace().library_version = "some 1.0";
  EXPECT_EQ(describe_contenders(standings(run_of(cells))).find("self-reported"), std::string::npos);
  cells[1].statistics->library_version += plugin::kSelfReportedNote;
  const std::string text = describe_contenders(standings(run_of(cells)));
  EXPECT_NE(text.find("mine (self-reported)  "), std::string::npos) << text;
  EXPECT_NE(text.find("self-reported: times of the program's own clock"), std::string::npos);
  EXPECT_EQ(text.find("samet ("), std::string::npos) << text;
}

TEST(Standings, ContendersWithoutTimesAreListedWithTheReason) {
  const std::vector<CellRecord> cells{cell_of({"samet", rounds(1.0)}),
                                      cell_of({"embree", {}, 0.0, "", Verdict::kMismatch}),
                                      cell_of({"exhaustive", rounds(9.0)}, "escena1", 100),
                                      cell_of({"beam", rounds(2)}, "escena2")};
  const nlohmann::json config{{"exclude", {{{"structure", "exhaustive"}, {"rays_above", 500}}}}};
  const Standings view = standings(run_of(cells, config)).at(0);
  ASSERT_EQ(view.left_out.size(), 3U);
  EXPECT_EQ(view.left_out[0].contender, "embree") << "in the order of the plan";
  EXPECT_EQ(view.left_out[0].reason, "mismatch: two hits are wrong");
  EXPECT_EQ(view.left_out[1].contender, "exhaustive");
  EXPECT_EQ(view.left_out[1].reason, "left out by the sweep (more than 500 rays)");
  EXPECT_EQ(view.left_out[2].contender, "beam");
  EXPECT_EQ(view.left_out[2].reason, "not in the record");
}

TEST(Standings, ContendersAreNamedByTheParametersThatDiffer) {
  const std::vector<CellRecord> cells{cell_of({"samet", rounds(1.0), 1.0, "max_level=6,root=cube"}),
                                      cell_of({"samet", rounds(2.0), 1.0, "max_level=7,root=cube"}),
                                      cell_of({"embree", rounds(3.0), 1.0, "mode=single"})};
  const Standings view = standings(run_of(cells)).at(0);
  EXPECT_EQ(view.ranked[0].contender, "samet max_level=6");
  EXPECT_EQ(view.ranked[2].contender, "embree");
}

TEST(Standings, TheBuildPaysOffWhereTheLinesIntersect) {
  // 3 ms more to build, 1 ms less for each thousand rays.
  const std::vector<CellRecord> cells{cell_of({"samet", rounds(1.0), 4.0}),
                                      cell_of({"embree", rounds(2.0), 1.0})};
  EXPECT_NEAR(*standings(run_of(cells)).at(0).break_even_rays(), 3000.0, 1.0);
  const std::vector<CellRecord> cheap{cell_of({"samet", rounds(1.0), 0.5}),
                                      cell_of({"embree", rounds(2.0), 1.0})};
  EXPECT_EQ(*standings(run_of(cheap)).at(0).break_even_rays(), 0.0);
}

TEST(Standings, MeansAreGeometricAndCountVictories) {
  const std::vector<CellRecord> cells{
      cell_of({"samet", rounds(1.0)}, "escena1"), cell_of({"embree", rounds(2.0)}, "escena1"),
      cell_of({"samet", rounds(8.0)}, "escena2"), cell_of({"embree", rounds(1.0)}, "escena2")};
  const auto views = standings(run_of(cells));
  const OverallStandings all = overall(views).at(0);
  ASSERT_EQ(all.means.size(), 2U);
  EXPECT_EQ(all.means[0].contender, "embree");
  EXPECT_NEAR(all.means[0].ratio.value, std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(all.means[1].ratio.value, std::sqrt(8.0), 1e-9);
  EXPECT_EQ(all.means[0].wins, 1);
  EXPECT_EQ(all.views, 2);
}

/// Returns the cell as measured by the shard with this number.
CellRecord of_shard(int shard, CellRecord cell) {
  cell.shard = shard;
  return cell;
}

TEST(Standings, TimesOfTwoMachinesAreNotCompared) {
  // At 1000 rays on one machine, at 4000 on another, with the opposite order.
  measure::Run run = run_of({of_shard(1, cell_of({"samet", rounds(1.0)})),
                             of_shard(1, cell_of({"embree", rounds(2.0)})),
                             of_shard(2, cell_of({"samet", rounds(9.0)}, "escena1", 4000)),
                             of_shard(2, cell_of({"embree", rounds(3.0)}, "escena1", 4000))});
  const nlohmann::ordered_json measurement{{"isa", "AVX2"}};
  run.manifest["shards"] = {
      {{"number", 1}, {"machine", {{"id", "0123456789abcdef"}}}, {"measurement", measurement}},
      {{"number", 2}, {"machine", {{"id", "fedcba9876543210"}}}, {"measurement", measurement}}};
  const auto views = standings(run);
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

TEST(Standings, AViewWithoutTimesIsReportedAsSuch) {
  const std::vector<CellRecord> cells{cell_of({"samet", {}, 0.0, "", Verdict::kError})};
  const auto views = standings(run_of(cells));
  EXPECT_TRUE(views[0].ranked.empty());
  EXPECT_NE(describe(views).find("no contender has a time"), std::string::npos);
  EXPECT_NE(describe_contenders(views).find("error: two hits are wrong"), std::string::npos);
}

/// The sweep may name a scene in any form, but the record has all parameters.
TEST(Standings, ASceneIsExcludedInAnyFormOfItsName) {
  const std::string whole = "escena1:seed=1999,spheres=430";
  const measure::Run run =
      run_of({cell_of({"samet", rounds(1.0)}, whole), cell_of({"embree", rounds(2.0)}, whole),
              cell_of({"beam", rounds(3.0)}, "escena2")});
  const auto reason = [&](const char* scene) {
    measure::Run excluding = run;
    excluding.config["exclude"] = {{{"structure", "beam"}, {"scene", scene}}};
    const Standings view = standings(excluding).at(0);
    return view.left_out.size() == 1 ? view.left_out[0].reason : "(not one is left out)";
  };
  EXPECT_EQ(standings(run).at(0).view, "escena1");
  EXPECT_EQ(reason("escena1"), "left out by the sweep (this scene)");
  EXPECT_EQ(reason(whole.c_str()), "left out by the sweep (this scene)");
  EXPECT_EQ(reason("escena2"), "not in the record");
}

TEST(Standings, OfAnInterruptedRunUseTheHighestResolutionOfTwoContenders) {
  const std::vector<CellRecord> cells{cell_of({"samet", rounds(1.0)}, "escena1", 1000),
                                      cell_of({"embree", rounds(2.0)}, "escena1", 1000),
                                      cell_of({"samet", rounds(5.0)}, "escena1", 4000),
                                      cell_of({"embree", rounds(6.0)}, "escena1", 4000),
                                      cell_of({"null", rounds(1.0)}, "escena1", 9000),
                                      cell_of({"samet", rounds(9.0)}, "escena1", 9000)};
  const Standings view = standings(run_of(cells)).at(0);
  EXPECT_EQ(view.rays, 4000U);
  EXPECT_EQ(view.size, "400x10");
  ASSERT_EQ(view.ranked.size(), 2U);
  EXPECT_NEAR(view.ranked[1].ratio.value, 1.2, 1e-12);
  EXPECT_EQ(view.left_out.at(0).contender, "null");
}

TEST(Standings, OfOneContenderUseItsHighestResolution) {
  const std::vector<CellRecord> cells{cell_of({"samet", rounds(1.0)}, "escena1", 1000),
                                      cell_of({"samet", rounds(5.0)}, "escena1", 4000)};
  const Standings view = standings(run_of(cells)).at(0);
  EXPECT_EQ(view.rays, 4000U);
  EXPECT_EQ(view.ranked.size(), 1U);
}

}  // namespace
}  // namespace beambench::analysis

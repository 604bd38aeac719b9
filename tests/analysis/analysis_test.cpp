// The analysis of a run: reasons for care, the exit code, the harness's share, the JSON.

#include "harness/analysis/analysis.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/analysis/exports.hpp"
#include "harness/analysis/words.hpp"
#include "harness/base/messages.hpp"
#include "harness/measure/record/conditions.hpp"
#include "tests/analysis/some_run.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::analysis {
namespace {

using measure::CellRecord;
using measure::QueryPath;
using scenes::says;
using verify::Verdict;
using Json = nlohmann::ordered_json;
using Reasons = std::vector<std::string>;

measure::Run quiet_run() {
  return run_of({cell_of({"samet", rounds(1.0)}), cell_of({"embree", rounds(2.0)})});
}

TEST(ReasonsForCare, AreNoneWithoutDisturbances) {
  const Analysis analysis = analyze(quiet_run());
  EXPECT_TRUE(analysis.reasons_for_care.empty());
  EXPECT_EQ(describe_verdicts(analysis),
            "Hits:  2 cells, all verified\n"
            "Times: measured on a quiet machine, as precisely as requested\n");
}

TEST(ReasonsForCare, AreTheNoiseAndOtherWork) {
  measure::Run run = quiet_run();
  run.manifest["measurement"]["other_work"] = 0.05;
  EXPECT_TRUE(reasons_for_care(run).empty());
  run.manifest["measurement"]["noise"] = 0.12;
  run.manifest["measurement"]["other_work"] = 1.5;
  EXPECT_EQ(reasons_for_care(run), (Reasons{"equal work took up to 12% longer than usual",
                                            "other work kept 1.50 processors busy"}));
  EXPECT_TRUE(
      says(describe_verdicts(analyze(run)), {"Times: use with care: equal work", "; other work"}));
}

TEST(ReasonsForCare, HaveTheThrottling) {
  measure::Run run = quiet_run();
  Json& throttling = run.manifest["measurement"]["throttling"];
  throttling = measure::to_json(Throttling{14, 0, 0.0});
  EXPECT_TRUE(reasons_for_care(run).empty());
  throttling = measure::to_json(Throttling{14, 12, 0.9});
  EXPECT_EQ(reasons_for_care(run), Reasons{"the kernel throttled the process in 12 of 14 periods "
                                           "of its CPU quota"});
}

TEST(ReasonsForCare, AreLittlePrecisionAndFewBlocks) {
  measure::Run run = quiet_run();
  run.cells[0].repetitions.resize(2);
  EXPECT_EQ(reasons_for_care(run), Reasons{"1 of 2 timed cells less precise than requested"});
  run.cells[0].verdict = Verdict::kMismatch;
  EXPECT_TRUE(reasons_for_care(run).empty()) << "it has no times";
  run.cells[1].repetitions.resize(1);
  EXPECT_EQ(reasons_for_care(run),
            (Reasons{"1 of 1 timed cell less precise than requested",
                     "1 of 1 timed cell repeated too few times for an interval"}));
}

TEST(ReasonsForCare, BeginWithAMachineThatWasNotSteady) {
  measure::Run run = quiet_run();
  for (CellRecord& cell : run.cells) {
    for (measure::Repetition& one : cell.repetitions) {
      if (one.block < 4) continue;
      one.trace_ms = one.trace_cpu_ms = 1.1 * one.trace_ms;
    }
  }
  EXPECT_TRUE(
      reasons_for_care(run).at(0).starts_with("the machine was not steady: late blocks took "
                                              "10."));
  const Analysis analysis = analyze(run);
  const TimeRatio ratio = analysis.views.at(0).ranked.at(1).ratio;
  EXPECT_LT(ratio.interval->low, 2.0 * (1.0 - analysis.steadiness->excess() / 2))
      << "widened by the variation that chance does not explain";
}

TEST(ReasonsForCare, ARecordOfOneProcessIsNotRanked) {
  const measure::Run run = run_of({of_one_process(cell_of({"samet", rounds(1.0)})),
                                   of_one_process(cell_of({"embree", rounds(2.0)}))});
  EXPECT_TRUE(reasons_for_care(run).at(0).starts_with("measured by one process, so unranked"));
}

TEST(ReasonsForCare, IncludeAnInterruptedRun) {
  measure::Run run = quiet_run();
  run.manifest["finished_utc"] = nullptr;
  run.cells[1].is_finished = false;
  run.cells[1].stop_reason.reset();
  run.cells[1].repetitions.resize(2);
  run.plan.push_back({2, "one that was not begun"});
  const Analysis analysis = analyze(run);
  EXPECT_EQ(analysis.reasons_for_care,
            (Reasons{"1 of 2 timed cells less precise than requested", "the run was cut off"}));
  EXPECT_EQ(analysis.cells, 2U);
  EXPECT_EQ(analysis.planned, 3U);
  EXPECT_EQ(analysis.views.at(0).ranked.size(), 2U) << "its times so far count";
}

TEST(ExitCode, IsThatOfTheWorstCell) {
  measure::Run run = quiet_run();
  EXPECT_EQ(exit_code_of(analyze(run)), base::kSuccess);
  run.cells[1].verdict = Verdict::kBaseline;
  EXPECT_EQ(exit_code_of(analyze(run)), base::kSuccess);
  run.cells[0].verdict = Verdict::kNoRays;
  EXPECT_EQ(exit_code_of(analyze(run)), base::kSuccess);
  for (const Verdict wrong : {Verdict::kMismatch, Verdict::kGrazes, Verdict::kError}) {
    run.cells[1].verdict = wrong;
    const Analysis analysis = analyze(run);
    EXPECT_EQ(exit_code_of(analysis), base::kMismatch);
    EXPECT_EQ(analysis.failed, 1U);
    EXPECT_TRUE(says(describe_verdicts(analysis),
                     {"Hits:  1 of 2 cells wrong or not built", "Rays:  1 of 2 cells have no"}));
  }
}

TEST(ExitCode, OfAWholeSweepWithoutRaysIsInvalidInput) {
  measure::Run run = quiet_run();
  for (CellRecord& cell : run.cells) cell.verdict = Verdict::kNoRays;
  EXPECT_EQ(exit_code_of(analyze(run)), base::kInvalidInput);
  run.manifest["shard"] = {{"number", 1}, {"count", 2}, {"cells", 2}, {"cells_of_sweep", 4}};
  EXPECT_TRUE(analyze(run).is_part);
  EXPECT_EQ(exit_code_of(analyze(run)), base::kSuccess);
}

/// Returns a cell with a camera of this name, traced by a query path with this harness share.
CellRecord with_share(const char* camera, QueryPath path, double harness_ms, double trace_ms) {
  CellRecord cell = cell_of({"samet", {trace_ms}});
  cell.id.camera = camera;
  cell.harness = {path, harness_ms};
  return cell;
}

TEST(Overhead, IsTheHarnesssLargestShare) {
  const auto single = QueryPath::kImageSingle;
  std::vector cells{with_share("a", single, 1.0, 200.0), with_share("b", single, 1.0, 50.0),
                    with_share("c", single, 2.0, 200.0),
                    with_share("makes no rays one by one", single, 2.0, 1.0)};
  const auto overheads = largest_overheads(run_of(cells));
  ASSERT_EQ(overheads.size(), 1U);
  EXPECT_NEAR(overheads[0].part, 0.02, 1e-12);
  EXPECT_TRUE(
      says(describe(overheads), {"at most 2%", "(escena1/b/100x10", "trace_net_ms_median"}));
  for (CellRecord& each : cells) each.verdict = Verdict::kMismatch;
  EXPECT_TRUE(largest_overheads(run_of(cells)).empty()) << "wrong times are not used";
  cells[1] = with_share("b", single, 1.0, 50.0);
  cells[1].verdict = Verdict::kBaseline;
  EXPECT_TRUE(largest_overheads(run_of(cells)).empty()) << "null is the harness's time itself";
  cells[1] = with_share("b", QueryPath::kPicture, 1.0, 50.0);
  EXPECT_TRUE(largest_overheads(run_of(cells)).empty())
      << "shading is part of the work of a whole picture";
  cells[1] = with_share("b", QueryPath::kImageOwn, 0.0, 50.0);
  EXPECT_TRUE(largest_overheads(run_of(cells)).empty()) << "this path has no separate harness time";
}

TEST(Overhead, IsStatedForEachQueryPath) {
  const std::vector cells{with_share("a", QueryPath::kImageSingle, 1.0, 50.0),
                          with_share("b", QueryPath::kImageSimd, 1.0, 4.0),
                          with_share("c", QueryPath::kList, 1.0, 100.0),
                          with_share("d", QueryPath::kImageSimd, 1.0, 5.0)};
  EXPECT_EQ(describe(largest_overheads(run_of(cells))),
            "harness overhead: at most 25% of a contender's trace time for images by SIMD rays "
            "(escena1/b/100x10/1/primary/samet), 2% for images by single rays "
            "(escena1/a/100x10/1/primary/samet), 1% for lists of rays "
            "(escena1/c/100x10/1/primary/samet); trace_net_ms_median in results.csv excludes it");
  const Json json = to_json(analyze(run_of(cells))).at("harness_overheads");
  ASSERT_EQ(json.size(), 3U);
  EXPECT_EQ(json[0], Json({{"query_path", "image-simd"},
                           {"cell", "escena1/b/100x10/1/primary/samet"},
                           {"title", "samet in escena1, camera b at 100x10"},
                           {"part", 0.25}}));
  EXPECT_NEAR(json[2].at("part").get<double>(), 0.01, 1e-12);
}

TEST(AnalysisJson, HasEachViewWithItsRatios) {
  const measure::Run run =
      run_of({cell_of({"samet", rounds(1.0), 4.0}), cell_of({"embree", rounds(2.0)}),
              cell_of({"null", rounds(0.1), 0.0, "", Verdict::kBaseline}),
              cell_of({"beam", {}, 0.0, "", Verdict::kMismatch})});
  const Json json = to_json(analyze(run));
  EXPECT_EQ(json.at("schema_version"), 2);
  EXPECT_EQ(json.at("cells"), 4);
  EXPECT_EQ(json.at("planned"), 4);
  EXPECT_EQ(json.at("failed"), 1);
  EXPECT_EQ(json.at("without_rays"), 0);
  EXPECT_EQ(json.at("is_part"), false);
  EXPECT_EQ(json.at("reasons_for_care"), Json::array());
  ASSERT_EQ(json.at("views").size(), 1U);
  const Json& view = json.at("views").at(0);
  EXPECT_EQ(view.at("view"), "escena1");
  EXPECT_EQ(view.at("size"), "100x10");
  EXPECT_EQ(view.at("rays"), 1000);
  const Json& ranked = view.at("ranked");
  ASSERT_EQ(ranked.size(), 2U);
  EXPECT_EQ(ranked[0].at("contender"), "samet");
  EXPECT_EQ(ranked[0].at("build_ms"), 4.0);
  EXPECT_NEAR(ranked[0].at("ns_per_ray").get<double>(), 1000.0, 0.2);
  EXPECT_EQ(ranked[0].at("rank"), "tied");
  EXPECT_EQ(ranked[1].at("rank"), "behind");
  EXPECT_EQ(ranked[1].at("ratio").at("paired"), true);
  EXPECT_NEAR(ranked[1].at("ratio").at("value").get<double>(), 2.0, 1e-12);
  EXPECT_TRUE(ranked[1].at("ratio").contains("low"));
  EXPECT_EQ(view.at("references").at(0).at("contender"), "null");
  EXPECT_EQ(view.at("left_out"), Json::parse(R"([{"contender": "beam",
                                                  "reason": "mismatch: two hits are wrong"}])"));
  EXPECT_NEAR(view.at("break_even").at("rays").get<double>(), 3000.0, 1.0);
  EXPECT_EQ(view.at("break_even").at("over"), "embree");
  const Json& mean = json.at("means").at(0).at("means").at(1);
  EXPECT_EQ(mean.at("contender"), "embree");
  EXPECT_EQ(mean.at("wins"), 0);
  EXPECT_EQ(mean.at("views"), 1);
}

TEST(AnalysisJson, HasNoNumberForABuildThatNeverPaysOff) {
  // samet is faster in each round, but its median time is the same: no number of rays compensates
  // for its build.
  const measure::Run run = run_of(
      {cell_of({"samet", {1, 1, 1, 1, 1, 1}, 9.0}), cell_of({"embree", {2, 2, 2, 2, 2, 2}})});
  Analysis analysis = analyze(run);
  analysis.views.at(0).ranked.at(1).ns_per_ray = analysis.views.at(0).ranked.at(0).ns_per_ray;
  const Json view = to_json(analysis).at("views").at(0);
  EXPECT_TRUE(view.at("break_even").at("rays").is_null());
  const measure::Run alone = run_of({cell_of({"samet", rounds(1.0)})});
  EXPECT_FALSE(to_json(analyze(alone)).at("views").at(0).contains("break_even"));
}

/// Writes the run's log as a sweep does, a round at a time.
void write_log(const measure::Run& run, const std::filesystem::path& folder) {
  measure::RunLog log = measure::RunLog::create(folder);
  Json manifest = run.manifest;
  manifest["finished_utc"] = nullptr;
  log.begin(manifest, run.config, run.plan);
  const measure::CellEvents events([&](const Json& event) { log.add(event); });
  for (const CellRecord& cell : run.cells) events.begin_cell(cell);
  for (std::size_t round = 0; round < 8; ++round) {
    for (const CellRecord& cell : run.cells) {
      if (round >= cell.repetitions.size()) continue;
      if (round == 0) events.add_verification(cell);
      CellRecord so_far = cell;
      so_far.repetitions.resize(round + 1);
      events.add_repetition(so_far);
    }
  }
  for (const CellRecord& cell : run.cells) {
    if (cell.is_finished) events.finish_cell(cell);
  }
  if (run.is_ended()) log.end(run.manifest.at("finished_utc").get<std::string>());
}

measure::Run run_of_all_kinds() {
  measure::Run run = run_of(
      {cell_of({"samet", rounds(1.0 / 3.0), 4.0, "max_level=6"}), cell_of({"embree", rounds(0.7)}),
       cell_of({"null", rounds(0.1), 0.0, "", Verdict::kBaseline}),
       cell_of({"beam", {}, 0.0, "", Verdict::kError}),
       cell_of({"samet", rounds(5.0), 4.0, "max_level=6"}, "escena1", 4000),
       cell_of({"embree", rounds(6.0)}, "escena2", 500)},
      {{"exclude", {{{"structure", "samet"}, {"scene", "escena2"}}}}});
  run.cells[0].harness = {QueryPath::kImageSingle, 0.01};
  return run;
}

TEST(Analysis, OfALogEqualsThatOfTheRun) {
  const TemporaryFolder folder;
  measure::Run run = run_of_all_kinds();
  write_log(run, folder.path() / "whole");
  EXPECT_EQ(to_json(analyze(measure::read_run(folder.path() / "whole"))), to_json(analyze(run)));
  run.manifest["finished_utc"] = nullptr;
  run.cells[4].is_finished = false;
  run.cells[4].stop_reason.reset();
  run.cells.pop_back();
  write_log(run, folder.path() / "cut off");
  EXPECT_EQ(to_json(analyze(measure::read_run(folder.path() / "cut off"))), to_json(analyze(run)));
}

TEST(Conclude, GeneratesEveryFileFromTheLogAlone) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run";
  const measure::Run run = run_of_all_kinds();
  write_log(run, path);
  const std::vector<std::string> names{"config.json",   "manifest.json", "results.csv",
                                       "analysis.json", "summary.txt",   "google-benchmark.json"};
  const Analysis analysis = conclude(path);
  std::vector<std::string> first;
  for (const std::string& name : names) first.push_back(read_text(path / name));
  EXPECT_EQ(nlohmann::json::parse(first[0]), run.config);
  EXPECT_EQ(Json::parse(first[3]), to_json(analysis));
  EXPECT_EQ(first[4], summary(analysis));
  const Json manifest = Json::parse(first[1]);
  EXPECT_TRUE(says(manifest.at("uncontrolled").dump(), {"harness overhead: at most 3%"}));
  for (const std::string& name : names) std::filesystem::remove(path / name);
  conclude(path);
  conclude(path);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(read_text(path / names[i]), first[i]) << names[i];
  }
}

}  // namespace
}  // namespace beambench::analysis

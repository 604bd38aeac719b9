// Whole sweeps over tiny scenes: correct cells keep their times, wrong cells lose them, and
// finished cells are not repeated.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "accel/core/registry.hpp"
#include "accel/embree/isa.hpp"
#include "harness/analysis/exports.hpp"
#include "harness/analysis/results_csv.hpp"
#include "harness/measure/record/cell_json.hpp"
#include "harness/measure/record/run_log.hpp"
#include "harness/measure/sweep_run.hpp"
#include "harness/measure/tuning.hpp"
#include "harness/rays/trace_results.hpp"
#include "scenes/catalogue.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::measure {
namespace {

using nlohmann::json;

/// A trace that a faulty structure corrupts.
struct Traced {
  const accel::HitSpan& buffer;    ///< with the right hits
  const accel::HitBuffer& before;  ///< the contents before the trace
  int pass;  ///< number of the trace: the counting pass is 0; repetition n has 2n - 1 and 2n
};
using Fault = std::function<void(const Traced&)>;

/// `exhaustive` with a fault.
class FaultyAccelerator : public accel::Accelerator {
 public:
  FaultyAccelerator(const scenes::Scene& scene, Fault fault, std::shared_ptr<int> passes)
      : right_(accel::registry().choose({"exhaustive", {}}).build(scene)),
        fault_(std::move(fault)),
        passes_(std::move(passes)) {}

  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override {
    accel::HitBuffer before(hits.width(), hits.height(), hits.samples());
    std::copy_n(hits.t(), before.size(), before.t());
    std::copy_n(hits.primitive(), before.size(), before.primitive());
    right_->closest_hits(rays, hits, context);
    if (rays.image() != nullptr) fault_({hits, before, (*passes_)++});
  }
  void any_hits(const accel::RaySource& rays, std::span<std::uint8_t> hits,
                const accel::QueryContext& context) const override {
    right_->any_hits(rays, hits, context);
    if (rays.batch() == nullptr) return;
    hits.front() = hits.front() == 0 ? 1 : 0;  // its fault with any-hit queries
  }
  accel::Statistics statistics() const override { return right_->statistics(); }

 private:
  std::unique_ptr<accel::Accelerator> right_;
  Fault fault_;
  std::shared_ptr<int> passes_;
};

void drop_one_hit(const accel::HitSpan& buffer) {
  buffer.set(buffer.index(16, 10, 0), std::nullopt);
}

class Sweep : public testing::Test {
 protected:
  Sweep() {
    for (const accel::StructureInfo& info : beambench::accel::registry().structures())
      structures_.add(info);
  }

  void add_faulty(const Fault& fault) {
    const auto passes = std::make_shared<int>(0);
    structures_.add(
        {"faulty",
         "A broken structure.",
         accel::Conformance::kBitExact,
         {},
         [fault, passes](const scenes::Scene& scene, const Parameters&, const accel::Workload&) {
           return std::make_unique<FaultyAccelerator>(scene, fault, passes);
         }});
  }

  static json config(const json& structures) {
    return {{"name", "test"},           {"scenes", {"tetra:n=2"}},
            {"structures", structures}, {"resolutions", {"32x20"}},
            {"precision", 0},           {"repetitions", {{"minimum", 4}, {"maximum", 4}}},
            {"budget_seconds", 1},      {"warm_up_seconds", 0}};
  }

  analysis::Analysis run(const json& document, bool resume = false) {
    SweepOptions options;
    options.resume = resume;
    return run(document, std::move(options));
  }
  analysis::Analysis run(const json& document, SweepOptions options) {
    const SweepConfig sweep = read_sweep(folder_.write("sweep.json", document.dump()), structures_);
    options.folder = results();
    options.tries = 1;  // the machine may be busy; the tests count repetitions
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> messages(
        std::fopen((folder_.path() / "messages").c_str(), "w"), std::fclose);
    return analysis::conclude(run_sweep(sweep, make_plan(sweep), GoogleBenchmark(BenchmarkFlags()),
                                        options, messages.get()));
  }

  std::filesystem::path results() const { return folder_.path() / "run"; }
  std::string messages() const { return read_text(folder_.path() / "messages"); }
  json read_json(const std::string& name) const { return json::parse(read_text(results() / name)); }
  /// Returns each cell of the log, with its row.
  std::vector<json> all_cells() const {
    const auto run = read_run(results());
    const RunFacts facts = analysis::facts_of(run.manifest);
    std::vector<json> found;
    for (const CellRecord& cell : run.cells) {
      json& one = found.emplace_back(json{{"name", cell.id.name()},
                                          {"message", cell.message},
                                          {"examples", cell.examples},
                                          {"hits_hash", cell.hits_hash.value_or(0)},
                                          {"row", analysis::to_row(facts, cell)}});
      one["repetitions"] = json::array();
      for (const Repetition& repetition : cell.repetitions) {
        one["repetitions"].push_back(json(repetition_json(repetition)));
      }
    }
    return found;
  }
  /// Returns the cells by the bare name of their structure.
  std::map<std::string, json> cells() const {
    std::map<std::string, json> found;
    for (const json& cell : all_cells()) found[cell["row"]["structure"].get<std::string>()] = cell;
    return found;
  }

  accel::Registry structures_;
  TemporaryFolder folder_;
};

/// Returns whether a column holds a time that every measured cell has. Four repetitions have no
/// intervals, and the net time is missing if a quick trace takes no longer than the harness.
bool is_time(const std::string& column) {
  return column.find("_ms_") != std::string::npos && column.find("_ci_") == std::string::npos &&
         column.find("_pi_") == std::string::npos && column != "trace_net_ms_median" &&
         !column.starts_with("update_");
}

void expect_times(const json& cell, bool has_times) {
  for (const auto& [column, value] : cell["row"].items()) {
    if (!is_time(column)) continue;
    EXPECT_EQ(value.is_number(), has_times) << column << " of " << cell["name"];
  }
}

TEST_F(Sweep, CorrectStructuresKeepTheirTimes) {
  const analysis::Analysis outcome =
      run(config({"null", "exhaustive", "samet:max_level=4", "embree:mode=single"}));
  EXPECT_EQ(outcome.cells, 4U);
  EXPECT_EQ(outcome.failed, 0U);
  for (const auto& [structure, cell] : cells()) {
    EXPECT_EQ(cell["row"]["verdict"], structure == "null" ? "baseline" : "ok");
    EXPECT_EQ(cell["row"]["stop_reason"], "repetitions");
    EXPECT_GT(cell["row"]["hits"], 0);
    EXPECT_EQ(cell["repetitions"].size(), 4U);
    expect_times(cell, true);
  }
  EXPECT_GT(cells()["samet"]["row"]["traversal_steps_per_ray"], 1.0);
  EXPECT_GT(cells()["samet"]["row"]["nodes"], 1);
  EXPECT_TRUE(cells()["embree"]["row"]["nodes"].is_null());
  EXPECT_EQ(cells()["samet"]["hits_hash"], cells()["exhaustive"]["hits_hash"]);
}

TEST_F(Sweep, SeveralThreadsTraceAndAreRecorded) {
  json document = config({"exhaustive", "beam", "embree"});
  document["threads"] = 2;
  run(document);
  for (const auto& [name, cell] : cells()) {
    EXPECT_EQ(cell["row"]["verdict"], "ok") << name;
    EXPECT_EQ(cell["row"]["threads"], 2) << name;
    EXPECT_GT(cell["row"]["trace_ms_median"], 0.0) << name;
    EXPECT_TRUE(cell["row"]["trace_cycles"].is_null()) << name;  // counted on one thread only
  }
  const json manifest = read_json("manifest.json");
  EXPECT_EQ(manifest["measurement"]["cpu_clock"], "CLOCK_PROCESS_CPUTIME_ID");
  EXPECT_EQ(manifest["measurement"]["pinned"], false);
}

TEST_F(Sweep, TheHarnessesOwnTimeIsReported) {
  const analysis::Analysis outcome = run(config({"null", "exhaustive"}));
  const json row = cells()["exhaustive"]["row"];
  EXPECT_GT(row["harness_ms"], 0.0);
  EXPECT_EQ(row["trace_net_ms_median"],
            row["trace_ms_median"].get<double>() - row["harness_ms"].get<double>());
  EXPECT_TRUE(cells()["null"]["row"]["trace_net_ms_median"].is_null());
  ASSERT_EQ(outcome.overheads.size(), 1U);
  EXPECT_EQ(outcome.overheads[0].path, "image-single");
  EXPECT_EQ(outcome.overheads[0].part,
            row["harness_ms"].get<double>() / row["trace_ms"].get<double>());
}

TEST_F(Sweep, EachQueryPathHasItsOwnShare) {
  json document =
      config({"null:rays=single", "samet:max_level=4", "beam", "tile-beam", "embree:mode=packet8"});
  document["resolutions"] = {"320x200"};
  run(document);
  const auto images = cells();
  const auto row = [&](const char* structure) { return images.at(structure).at("row"); };
  EXPECT_EQ(row("null")["query_path"], "image-single");
  EXPECT_EQ(row("samet")["query_path"], "image-single");
  EXPECT_EQ(row("samet")["harness_ms"], row("null")["harness_ms"]);
  EXPECT_EQ(row("embree")["query_path"], "image-simd");
  EXPECT_GT(row("embree")["harness_ms"], 0.0);
  EXPECT_NE(row("embree")["harness_ms"], row("null")["harness_ms"]);
  for (const char* structure : {"beam", "tile-beam"}) {
    EXPECT_EQ(row(structure)["query_path"], "image-own") << structure;
    EXPECT_EQ(row(structure)["harness_ms"], 0.0) << structure;
    EXPECT_EQ(row(structure)["trace_net_ms_median"], row(structure)["trace_ms_median"])
        << structure;
  }
  EXPECT_EQ(row("embree")["library_geometry"], "triangles");
  EXPECT_TRUE(row("samet")["library_geometry"].is_null());
  EXPECT_EQ(row("embree")["library_version"], "Embree " + accel::embree::embree_version());
  EXPECT_TRUE(row("samet")["library_version"].is_null());
  const std::string overheads = read_json("analysis.json")["harness_overheads"].dump();
  EXPECT_TRUE(scenes::says(overheads, {"image-single"}));
  EXPECT_FALSE(scenes::says(overheads, {"image-own"}));
}

TEST_F(Sweep, AListOfRaysIsReadOneByOneOrInPackets) {
  json document = config({"exhaustive", "tile-beam", "embree:mode=packet8"});
  document["rays"] = {"diffuse"};
  run(document);
  const auto lists = cells();
  const auto row = [&](const char* structure) { return lists.at(structure).at("row"); };
  EXPECT_EQ(row("exhaustive")["query_path"], "list");
  EXPECT_EQ(row("tile-beam")["query_path"], "list");
  EXPECT_EQ(row("tile-beam")["harness_ms"], row("exhaustive")["harness_ms"]);
  EXPECT_EQ(row("embree")["query_path"], "list-packed");
  EXPECT_GT(row("embree")["harness_ms"], 0.0);
}

/// Returns the resident memory of this process, in bytes; 0 if unknown.
std::uint64_t resident_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::uint64_t kibibytes = 0;
    if (word == "VmRSS:" && status >> kibibytes) return 1024 * kibibytes;
  }
  return 0;
}

/// Each cell once took 20 kB or more during the run, and as much again at its end.
TEST_F(Sweep, MemoryDoesNotGrowWithTheCells) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer's own memory grows";
#endif
  json document = config({"null", "exhaustive"});
  document["scenes"] = {"tetra:n=1"};
  document["repetitions"] = {{"minimum", 12}, {"maximum", 12}};
  document["resolutions"] = json::array();
  for (int width = 1; width <= 150; ++width) {
    document["resolutions"].push_back(fmt::format("{}x1", width));
  }
#ifdef __GLIBC__
  malloc_trim(0);  // memory freed by earlier tests of this process would hide growth
#endif
  std::vector<std::uint64_t> resident;
  SweepOptions options;
  options.before_each_piece = [&] { resident.push_back(resident_bytes()); };
  EXPECT_EQ(run(document, options).cells, 300U);
  if (resident.front() == 0) GTEST_SKIP() << "the system does not report memory use";
  const std::uint64_t early = resident[resident.size() / 10];
  constexpr std::uint64_t kMax = std::uint64_t{3} << 20U;  // 10 kB for each of the other cells
  EXPECT_LT(resident.back(), early + kMax) << "while the last cell is measured";
  EXPECT_LT(resident_bytes(), early + kMax) << "at the end";
}

TEST_F(Sweep, TheFolderHoldsTheWholeRecord) {
  run(config({"null", "samet:max_level=4"}));
  const std::string table = read_text(results() / "results.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3);
  EXPECT_EQ(read_json("config.json"), config({"null", "samet:max_level=4"}));
  const json manifest = read_json("manifest.json");
  EXPECT_EQ(manifest["scenes"][0]["name"], "tetra:n=2");
  EXPECT_FALSE(manifest["finished_utc"].is_null());
  EXPECT_EQ(manifest["program"]["libraries"]["google_benchmark"].get<std::string>().substr(0, 1),
            "1");
  EXPECT_EQ(read_json("analysis.json")["cells"], 2);
  EXPECT_TRUE(scenes::says(read_text(results() / "summary.txt"), {"2 cells, all verified"}));
  const json google = read_json("google-benchmark.json");
  EXPECT_EQ(google["context"]["beambench_run_id"], manifest["run_id"]);
  ASSERT_EQ(google["benchmarks"].size(), 8U);
  const json& first = google["benchmarks"][0];
  EXPECT_EQ(first["time_unit"], "ms");
  EXPECT_NEAR(first["real_time"].get<double>(),
              first["build_ms"].get<double>() + first["trace_ms"].get<double>(), 1e-9);
}

TEST_F(Sweep, ContendersTakeTurns) {
  run(config({"null", "exhaustive", "samet:max_level=4"}));
  std::map<int, std::set<int>> positions;
  for (const auto& [structure, cell] : cells()) {
    int round = 0;
    for (const json& repetition : cell["repetitions"]) {
      EXPECT_EQ(repetition["round"], round);
      positions[round++].insert(repetition["position"].get<int>());
    }
  }
  ASSERT_EQ(positions.size(), 4U);
  for (const auto& [round, taken] : positions) EXPECT_EQ(taken, (std::set<int>{0, 1, 2}));
}

/// Ensures that a slow half-minute affects some blocks of every view, not all blocks of one.
TEST_F(Sweep, BlocksOfAllViewsAreSpreadOverTheRun) {
  std::vector<std::size_t> rays;  // of each trace
  add_faulty([&](const Traced& traced) { rays.push_back(traced.buffer.size()); });
  json document = config({"faulty"});
  document["resolutions"] = {"4x4", "8x4", "8x8"};
  document["repetitions"] = {{"minimum", 12}, {"maximum", 12}, {"second_traces", 0}};
  run(document);
  constexpr std::size_t kViews = 3, kBlocks = 4, kEach = 3;
  ASSERT_EQ(rays.size(), kViews * (1 + kBlocks * kEach)) << "with the counting passes";
  const std::set<std::size_t> all{16, 32, 64};
  const std::span later = std::span(rays).last(kViews * (kBlocks - 1) * kEach);
  for (std::size_t first = 0; first < later.size(); first += kViews * kEach) {
    const auto pass = later.subspan(first, kViews * kEach);
    EXPECT_EQ(std::set(pass.begin(), pass.end()), all);
    for (std::size_t block = 0; block < pass.size(); block += kEach) {
      const auto own = pass.subspan(block, kEach);
      EXPECT_EQ(std::set(own.begin(), own.end()).size(), 1U) << "a block belongs to one view";
    }
  }
  const json cell = all_cells()[0];
  EXPECT_EQ(cell["row"]["blocks"], 4);
  EXPECT_EQ(cell["row"]["trace_clock"].is_string(), true);
}

TEST_F(Sweep, TheNumberOfBlocksFollowsThePrecisionOrTheSweep) {
  json document = config({"exhaustive"});
  document["repetitions"] = {{"minimum", 3}, {"maximum", 60}};
  document["budget_seconds"] = 1000;
  document["precision"] = 1.0;
  document["blocks"] = 5;
  run(document);
  EXPECT_EQ(cells()["exhaustive"]["row"]["blocks"], 5);
  EXPECT_EQ(cells()["exhaustive"]["row"]["stop_reason"], "precision");
  std::filesystem::remove_all(results());
  document["precision"] = 0;
  run(document);
  EXPECT_EQ(cells()["exhaustive"]["row"]["blocks"], 20);
  EXPECT_EQ(cells()["exhaustive"]["row"]["stop_reason"], "repetitions");
  std::filesystem::remove_all(results());
  document["budget_seconds"] = 0;
  run(document);
  EXPECT_EQ(cells()["exhaustive"]["row"]["blocks"], 1) << "the minimum of repetitions";
  EXPECT_EQ(cells()["exhaustive"]["row"]["stop_reason"], "budget");
}

/// A fault in the hits, and the message about it.
struct Planted {
  const char* name;
  Fault fault;
  const char* words;
};

class PlantedSweepFault : public Sweep, public testing::WithParamInterface<Planted> {};

TEST_P(PlantedSweepFault, LosesItsOwnTimesOnly) {
  add_faulty(GetParam().fault);
  const analysis::Analysis outcome = run(config({"faulty", "exhaustive"}));
  EXPECT_EQ(outcome.cells, 2U);
  EXPECT_EQ(outcome.failed, 1U);
  const json faulty = cells()["faulty"];
  EXPECT_EQ(faulty["row"]["verdict"], "mismatch");
  EXPECT_TRUE(scenes::says(faulty["message"].get<std::string>(), {GetParam().words}));
  EXPECT_TRUE(scenes::says(messages(), {"mismatch: tetra:n=2/default/32x20/1/primary/faulty"}));
  EXPECT_GT(faulty["row"]["primitive_tests_per_ray"], 0);
  expect_times(faulty, false);
  EXPECT_EQ(cells()["exhaustive"]["row"]["verdict"], "ok");
  expect_times(cells()["exhaustive"], true);
}

INSTANTIATE_TEST_SUITE_P(
    , PlantedSweepFault,
    testing::Values(Planted{"ShiftedT",
                            [](const Traced& traced) {
                              for (std::size_t i = 0; i < traced.buffer.size(); ++i) {
                                if (traced.buffer.get(i)) traced.buffer.t()[i] *= 1.001F;
                              }
                            },
                            "wrong hit"},
                    Planted{"OneDroppedHit",
                            [](const Traced& traced) { drop_one_hit(traced.buffer); },
                            "1 of 640 rays got a wrong hit"},
                    Planted{"OneSampleLeftAsItWas",
                            [](const Traced& traced) {
                              traced.buffer.t()[0] = traced.before.t()[0];
                              traced.buffer.primitive()[0] = traced.before.primitive()[0];
                            },
                            "1 of 640 rays got a wrong hit"},
                    Planted{"AnotherAnswerInTheThirdRepetition",
                            [](const Traced& traced) {
                              if (traced.pass == 5) drop_one_hit(traced.buffer);
                            },
                            "repetition 3 wrote different hits"},
                    Planted{"AnotherAnswerInASecondTrace",
                            [](const Traced& traced) {
                              if (traced.pass == 4) drop_one_hit(traced.buffer);
                            },
                            "a second trace of the same structure"},
                    Planted{"AnotherAnswerWhileCounting",
                            [](const Traced& traced) {
                              if (traced.pass == 0) drop_one_hit(traced.buffer);
                            },
                            "the counting pass found different hits"}),
    [](const auto& planted) { return planted.param.name; });

TEST_F(Sweep, TracesEveryKindOfRays) {
  json all = config({"exhaustive", "samet:max_level=4", "embree"});
  all["rays"] = {"primary",        "shadow",       "area:samples=2", "reflection",
                 "diffuse:seed=3", "ao:samples=2", "path",           "random"};
  EXPECT_EQ(run(all).failed, 0U);
  std::map<std::string, std::set<json>> hashes;
  for (const json& cell : all_cells()) {
    const json& row = cell["row"];
    const std::string kind = row["ray_kind"];
    hashes[kind].insert(row["rays_hash"]);
    const bool of_lights = kind == "shadow" || kind == "area:samples=2";
    const bool any_hit = of_lights || kind == "ao:samples=2";
    EXPECT_EQ(row["query"], any_hit ? "any" : "closest");
    EXPECT_EQ(row["hit_share"].is_null(), any_hit);
    EXPECT_EQ(row["occluded_share"].is_null(), !any_hit);
    const json share = any_hit ? row["occluded_share"] : row["hit_share"];
    EXPECT_EQ(share.get<double>(), row["hits"].get<double>() / row["rays"].get<double>());
    const bool seeded = any_hit ? !of_lights : kind == "random" || kind == "path";
    EXPECT_EQ(row["seed"], kind == "diffuse:seed=3" ? 3 : seeded ? 1 : 0);
    EXPECT_LE(row["coherence"].get<double>(), 1.0);
  }
  EXPECT_EQ(hashes.size(), 8U);
  for (const auto& [kind, of_kind] : hashes) EXPECT_EQ(of_kind.size(), 1U) << kind;
}

TEST_F(Sweep, BothOrdersOfAListFormOneView) {
  json both = config({"exhaustive", "embree"});
  both["rays"] = {"diffuse", "diffuse:order=sorted"};
  const analysis::Analysis outcome = run(both);
  EXPECT_EQ(outcome.failed, 0U);
  ASSERT_EQ(outcome.views.size(), 1U);
  EXPECT_EQ(outcome.views.front().ray_kind, "diffuse");
  std::set<std::string> contenders;
  for (const auto& one : outcome.views.front().ranked) contenders.insert(one.contender);
  for (const auto& one : outcome.views.front().references) contenders.insert(one.contender);
  EXPECT_EQ(contenders, (std::set<std::string>{"exhaustive", "exhaustive, sorted rays", "embree",
                                               "embree, sorted rays"}));
  std::map<std::string, std::set<json>> hashes, rays;
  for (const json& cell : all_cells()) {
    hashes[cell["row"]["order"]].insert(cell["row"]["rays_hash"]);
    rays[cell["row"]["order"]].insert(cell["row"]["rays"]);
  }
  EXPECT_EQ(hashes.at("list").size(), 1U);
  EXPECT_EQ(hashes.at("sorted").size(), 1U);
  EXPECT_NE(hashes.at("list"), hashes.at("sorted"));
  EXPECT_EQ(rays.at("list"), rays.at("sorted"));
}

/// Returns the events of one kind in a log.
std::vector<json> log_events(const std::filesystem::path& run, const std::string& kind) {
  std::vector<json> found;
  for_each_event(run, [&](const nlohmann::ordered_json& event) {
    if (event.at("event") == kind) found.emplace_back(event);
  });
  return found;
}

TEST_F(Sweep, TunedContendersAreMeasuredWithTheirTwoFastestParameterSets) {
  const json tuned{
      {"structure", "samet"}, {"parameters", {{"max_level", {1, 2, 3, 4}}}}, {"tune", true}};
  const analysis::Analysis outcome = run(config({"exhaustive", tuned}));
  EXPECT_EQ(outcome.failed, 0U);
  EXPECT_EQ(outcome.planned, 3U);
  ASSERT_EQ(outcome.views.size(), 1U);
  ASSERT_EQ(outcome.views.front().ranked.size(), 1U)
      << "the faster of the two represents all parameter sets";
  const analysis::Standing& shown = outcome.views.front().ranked.front();
  EXPECT_EQ(shown.contender, "samet (best of 4)");
  EXPECT_TRUE(shown.name().starts_with("samet:max_level=") &&
              shown.name().ends_with(" (best of 4)"))
      << shown.name();

  const std::vector<json> tunings = log_events(results(), "tuning");
  ASSERT_EQ(tunings.size(), 1U);
  EXPECT_EQ(tunings.front()["candidates"].size(), 4U);
  std::map<int, double> times;
  for (const json& each : tunings.front()["candidates"]) times[each["index"]] = each["trace_ms"];
  for (const int kept : tunings.front()["kept"].get<std::vector<int>>()) {
    EXPECT_LE(std::ranges::count_if(times, [&](const auto& t) { return t.second < times[kept]; }),
              1);
  }
  EXPECT_EQ(std::ranges::count_if(
                all_cells(), [](const json& cell) { return cell["row"]["parameter_sets"] == 4; }),
            2);
}

TEST_F(Sweep, ATunedRunIsResumedWithTheChosenSets) {
  const json tuned{
      {"structure", "samet"}, {"parameters", {{"max_level", {1, 2, 3, 4}}}}, {"tune", true}};
  const json document = config(json::array({tuned}));
  run(document);
  const std::string table = read_text(results() / "results.csv");
  EXPECT_EQ(run(document, true).planned, 2U);
  EXPECT_EQ(log_events(results(), "tuning").size(), 1U);
  EXPECT_EQ(read_text(results() / "results.csv"), table);
}

TEST_F(Sweep, AParameterSetThatCannotBeBuiltLosesTheTuning) {
  structures_.add({"picky",
                   "Fails for some.",
                   accel::Conformance::kBitExact,
                   {integer_parameter("n", 0, 0, 9, "of what")},
                   [](const scenes::Scene& scene, const Parameters& parameters,
                      const accel::Workload&) -> std::unique_ptr<accel::Accelerator> {
                     if (parameters.integer("n") < 2) throw InputError("n is too small");
                     return accel::registry().choose({"exhaustive", {}}).build(scene);
                   }});
  const json tuned{{"structure", "picky"}, {"parameters", {{"n", {0, 1, 2}}}}, {"tune", true}};
  EXPECT_EQ(run(config(json::array({tuned}))).failed, 0U);
  const json tuning = log_events(results(), "tuning").front();
  EXPECT_EQ(tuning["kept"], json({2}));
  EXPECT_EQ(tuning["candidates"][0]["error"], "n is too small");
}

TEST(Tuning, TheCameraIsTurnedAboutItsPosition) {
  scenes::Camera camera;
  camera.from = {0.0F, 0.0F, 10.0F};
  camera.at = {0.0F, 0.0F, 0.0F};
  camera.angle = 60.0F;
  const scenes::Camera turned = tuning_camera(camera);
  EXPECT_EQ(turned.from, camera.from);
  EXPECT_NEAR(turned.at.x, -10.0 * std::sin(std::numbers::pi / 12), 1e-5);
  EXPECT_NEAR(turned.at.z, 10.0 - 10.0 * std::cos(std::numbers::pi / 12), 1e-5);
  EXPECT_NEAR(turned.at.y, 0.0, 1e-6);
}

/// When the camera moved around what it looks at, it left the rooms, and the mode of Embree was
/// arbitrary there.
TEST(Tuning, TheCameraSeesEverySceneOfTheCatalog) {
  for (const scenes::SceneInfo& info : scenes::scene_catalogue()) {
    if (!info.origin.empty()) continue;
    const scenes::Scene scene = scenes::load_scene(info.name);
    const auto structure =
        accel::registry().choose({"sah-bvh", {{"builder", "lbvh"}}}).build(scene);
    for (const scenes::Camera& camera : scene.cameras) {
      const auto hits = [&](const scenes::Camera& from) {
        const rays::ImageOfRays image = rays::image_of(from, rays::Resolution{32, 24}, 1);
        const rays::TraceInput input = image.rays();
        rays::TraceResults results = rays::make_results(input);
        rays::trace(*structure, input, results);
        const auto& buffer = std::get<accel::HitBuffer>(results);
        return std::count_if(buffer.primitive(), buffer.primitive() + buffer.size(),
                             [](std::uint32_t id) { return id != scenes::kNoPrimitive; });
      };
      EXPECT_GT(2 * hits(tuning_camera(camera)), hits(camera)) << info.name << ", " << camera.name;
    }
  }
}

TEST(Tuning, KeepsAllSetsIfNoneHasATime) {
  const std::vector<std::size_t> all{3, 4, 5, 6};
  EXPECT_EQ(fastest({}, all), all);
  EXPECT_EQ(fastest({{5, 2.0}, {3, 1.0}, {4, 3.0}}, all), (std::vector<std::size_t>{3, 5}));
}

TEST(Tuning, EmbreesModesKeepWithinTheBudget) {
  const auto sets = best_embree(accel::registry());
  std::set<std::string> labels;
  for (const accel::StructureChoice& each : sets) labels.insert(each.label());
  EXPECT_EQ(labels.size(), sets.size());
  EXPECT_LE(sets.size(), kMaxParameterSets);
  EXPECT_GE(sets.size(), 6U);
}

TEST_F(Sweep, DrawsWholePictures) {
  json whole = config({"null", "exhaustive", "samet:max_level=4", "beam", "embree"});
  whole["scenes"] = {"balls:n=1"};
  whole["rays"] = {"whitted"};
  const analysis::Analysis outcome = run(whole);
  EXPECT_EQ(outcome.failed, 0U);
  for (const auto& [structure, cell] : cells()) {
    const json& row = cell["row"];
    EXPECT_EQ(row["query"], "picture");
    EXPECT_EQ(row["camera_rays"], 640);
    EXPECT_EQ(row["hit_share"].is_null() || row["occluded_share"].is_null(), false);
    expect_times(cell, true);
    if (structure == "null") continue;
    EXPECT_GT(row["shadow_rays"], 0);
    EXPECT_GT(row["reflected_rays"], 0);
    EXPECT_EQ(row["refracted_rays"], 0);
  }
  const json row = cells()["exhaustive"]["row"];
  EXPECT_EQ(row["camera_primitive_tests_per_ray"], row["primitives"]);
  EXPECT_EQ(row["reflected_primitive_tests_per_ray"], row["primitives"]);
  EXPECT_LT(row["shadow_primitive_tests_per_ray"], row["primitives"]);
  EXPECT_LT(row["harness_ms"], row["trace_ms_median"]) << "shading alone";
  EXPECT_FALSE(row.contains("refracted_primitive_tests_per_ray"));
  EXPECT_EQ(cells()["beam"]["hits_hash"], cells()["exhaustive"]["hits_hash"]);
}

TEST_F(Sweep, AWrongAnyHitLosesItsTimes) {
  add_faulty([](const Traced&) {});
  json shadow = config({"faulty", "exhaustive"});
  shadow["rays"] = {"shadow"};
  EXPECT_EQ(run(shadow).failed, 1U);
  const json faulty = cells()["faulty"];
  EXPECT_EQ(faulty["row"]["verdict"], "mismatch");
  EXPECT_EQ(faulty["row"]["structure_error"], 1);
  expect_times(faulty, false);
  EXPECT_TRUE(
      scenes::says(faulty["examples"][0].get<std::string>(), {"ray 0", "--rays shadow --ray 0"}));
}

TEST_F(Sweep, KindsOfRaysThatASceneLacksAreReportedAsRows) {
  const auto dark = folder_.write("dark.nff",
                                  "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\n"
                                  "resolution 8 8\nf 1 0 0 1 0 0 0 0\ns 0 0 0 1\n");
  json config = this->config({"exhaustive"});
  config["scenes"] = {dark.string()};
  config["structures"] = {"exhaustive", "samet"};
  config["rays"] = {"shadow", "primary"};
  const analysis::Analysis outcome = run(config);
  EXPECT_EQ(outcome.cells, 4U);
  EXPECT_EQ(outcome.failed, 0U);
  EXPECT_EQ(outcome.without_rays, 2U);
  EXPECT_TRUE(scenes::says(messages(), {"has no lights"}));
  EXPECT_TRUE(scenes::says(messages(), {"primary/exhaustive: build"}));

  // A record with only this kind of rays also has the rows.
  std::filesystem::remove_all(results());
  config["rays"] = {"shadow"};
  EXPECT_EQ(run(config).without_rays, 2U);
  const json cell = cells().at("samet");
  EXPECT_EQ(cell["row"]["verdict"], "no_rays");
  EXPECT_EQ(cell["row"]["rays"], 0);
  EXPECT_EQ(cell["row"]["primitives"], 1);
  EXPECT_TRUE(scenes::says(cell["message"].get<std::string>(), {"has no lights"}));
  expect_times(cell, false);
}

TEST_F(Sweep, WarnsAboutRaysThatNeverHit) {
  json config = this->config({"exhaustive"});
  config["scenes"] = {"escena2"};
  config["rays"] = {"reflection"};
  EXPECT_EQ(run(config).failed, 0U);
  EXPECT_TRUE(
      scenes::says(messages(), {"warning: escena2/default/32x20/1/reflection", "hit something"}));
  EXPECT_TRUE(scenes::says(read_json("manifest.json")["uncontrolled"].dump(), {"reflection"}));
}

TEST_F(Sweep, AWrongHitIsDescribed) {
  add_faulty([](const Traced& traced) { drop_one_hit(traced.buffer); });
  run(config({"faulty"}));
  ASSERT_EQ(cells()["faulty"]["examples"].size(), 1U);
  EXPECT_TRUE(scenes::says(cells()["faulty"]["examples"][0].get<std::string>(), {"16", "10"}));
}

TEST_F(Sweep, AStructureThatCannotBeBuiltIsAnErrorAndTheRunContinues) {
  const analysis::Analysis outcome =
      run(config({"samet:max_level=8,max_references=1", "exhaustive"}));
  EXPECT_EQ(outcome.failed, 1U);
  const json samet = cells()["samet"];
  EXPECT_EQ(samet["row"]["verdict"], "error");
  EXPECT_TRUE(scenes::says(samet["message"].get<std::string>(), {"max_references"}));
  expect_times(samet, false);
  EXPECT_EQ(cells()["exhaustive"]["row"]["verdict"], "ok");
  const json google = read_json("google-benchmark.json");
  EXPECT_EQ(google["benchmarks"][0]["error_occurred"], true);
}

TEST_F(Sweep, AnExceptionInATimedRepetitionEndsThatCellOnly) {
  add_faulty([](const Traced& traced) {
    if (traced.pass == 3) throw std::runtime_error("worn out");
  });
  run(config({"faulty", "exhaustive"}));
  EXPECT_EQ(cells()["faulty"]["row"]["verdict"], "error");
  EXPECT_EQ(cells()["faulty"]["message"], "worn out");
  expect_times(cells()["faulty"], false);
  EXPECT_EQ(cells()["exhaustive"]["row"]["verdict"], "ok");
}

class Resume : public Sweep {
 protected:
  Resume() {
    // The traces are counted, and are correct unless `fault_` is set.
    add_faulty([this](const Traced& traced) {
      ++traces_;
      fault_(traced);
    });
  }

  std::vector<std::string> log() const {
    std::istringstream text(read_text(results() / kLogName));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line + '\n');
    return lines;
  }
  void write_log(std::span<const std::string> lines, const std::string& part = "") const {
    folder_.write("run/run.jsonl",
                  std::accumulate(lines.begin(), lines.end(), std::string()) + part);
  }
  /// Changes a member of the first event of that kind.
  void write_changed(std::vector<std::string> lines, const char* kind, const char* pointer,
                     const json& value) const {
    for (std::string& line : lines) {
      auto event = nlohmann::ordered_json::parse(line);
      if (event.at("event") != kind) continue;
      event[nlohmann::ordered_json::json_pointer(pointer)] = value;
      line = event.dump() + '\n';
      break;
    }
    write_log(lines);
  }

  json config_ = config({"faulty", "exhaustive"});
  int traces_ = 0;
  Fault fault_ = [](const Traced&) {};
};

/// Ends a run like Ctrl-C.
struct SweepStopped : std::runtime_error {
  SweepStopped() : std::runtime_error("interrupted") {}
};

TEST_F(Resume, OnlyTheFirstRepetitionsHaveASecondTrace) {
  config_["repetitions"]["second_traces"] = 1;
  run(config_);
  EXPECT_EQ(traces_, 6);  // the counting pass, four repetitions, one second trace
}

TEST_F(Resume, NoRepetitionNeedsASecondTrace) {
  config_["repetitions"]["second_traces"] = 0;
  EXPECT_EQ(run(config_).failed, 0U);
  EXPECT_EQ(traces_, 5);
  EXPECT_TRUE(cells()["faulty"]["row"]["trace_warm_ms_median"].is_null());
  EXPECT_EQ(messages().find("second trace"), std::string::npos);
  EXPECT_EQ(run(config_, true).cells, 2U) << "the written log can be read";
}

TEST_F(Resume, RepeatsNoFinishedCell) {
  run(config_);
  const std::string table = read_text(results() / "results.csv");
  const int traces = std::exchange(traces_, 0);
  EXPECT_EQ(traces, 9);  // the counting pass and four repetitions of two traces
  EXPECT_EQ(run(config_, true).cells, 2U);
  EXPECT_EQ(traces_, 0);
  EXPECT_EQ(read_text(results() / "results.csv"), table);
}

TEST_F(Resume, MeasuresTheMissingCells) {
  config_["scenes"] = {"tetra:n=1", "tetra:n=2"};
  run(config_);
  const std::string run_id = read_json("manifest.json")["run_id"];
  const std::vector<json> before = all_cells();
  const std::vector<std::string> lines = log();
  const auto second = std::ranges::find_if(lines, [](const std::string& line) {
    return line.find(R"("event":"cell","index":2)") != std::string::npos;
  });
  ASSERT_NE(second, lines.end());
  write_log(std::span(lines.begin(), second));
  traces_ = 0;
  EXPECT_EQ(run(config_, true).cells, 4U);
  EXPECT_EQ(traces_, 9) << "only the traces of the second scene";
  const std::vector<json> after = all_cells();
  ASSERT_EQ(after.size(), 4U);
  EXPECT_EQ(after[0], before[0]);
  EXPECT_EQ(after[1], before[1]);
  EXPECT_EQ(after[2]["row"]["run_id"], run_id);
  EXPECT_EQ(read_json("google-benchmark.json")["benchmarks"].size(), 16U);
}

/// Returns the number of traces missing for the cell `faulty` of a resumed run: none for a finished
/// cell; otherwise the counting pass, if its hits are not yet verified, and two for each repetition
/// not in the log.
int owed_traces(std::span<const std::string> lines, int index) {
  const auto count = [&](const char* kind) {
    return static_cast<int>(std::ranges::count_if(lines, [&](const std::string& line) {
      const json event = json::parse(line);
      return event.at("event") == kind && event.at("index") == index;
    }));
  };
  if (count("finished") > 0) return 0;
  return (count("verification") > 0 ? 0 : 1) + 2 * (4 - count("repetition"));
}

TEST_F(Resume, NoRepetitionInTheLogIsRepeated) {
  run(config_);
  const std::vector<std::string> lines = log();
  ASSERT_EQ(lines.size(), 17U) << "for each cell: its own line, four repetitions, two other lines";
  const int faulty = json::parse(lines[2]).at("structure") == "faulty" ? 0 : 1;
  for (std::size_t kept = 1; kept <= lines.size(); ++kept) {
    const auto begin = std::span(lines).first(kept);
    // The log may also be truncated within a line.
    const std::string part = kept < lines.size() ? lines[kept].substr(0, kept) : "";
    write_log(begin, part);
    const std::vector<json> before = all_cells();
    traces_ = 0;
    EXPECT_EQ(run(config_, true).cells, 2U);
    EXPECT_EQ(traces_, owed_traces(begin, faulty)) << kept;
    const std::vector<std::string> after = log();
    EXPECT_TRUE(std::ranges::equal(begin, std::span(after).first(kept))) << kept;
    for (const json& cell : all_cells()) {
      EXPECT_EQ(cell["row"]["verdict"], "ok") << kept;
      EXPECT_EQ(cell["row"]["stop_reason"], "repetitions") << kept;
      ASSERT_EQ(cell["repetitions"].size(), 4U) << kept;
      for (std::size_t i = 1; i < 4; ++i) {
        EXPECT_GT(cell["repetitions"][i]["round"], cell["repetitions"][i - 1]["round"]) << kept;
      }
    }
    for (const json& cell : before) {
      const json now = cells().at(cell["row"]["structure"].get<std::string>());
      for (const char* column : {"rays_hash", "hits", "agree", "primitive_tests_per_ray"}) {
        EXPECT_EQ(now["row"][column], cell["row"][column]) << kept;
      }
      EXPECT_EQ(now["hits_hash"], cell["hits_hash"]) << kept;
    }
  }
}

/// The repetitions of all contenders must still form common rounds.
TEST_F(Resume, RoundsOfAViewContinueAfterTheLastOfAll) {
  run(config_);
  const std::vector<std::string> lines = log();
  write_log(std::span(lines).first(9));
  const std::vector<json> before = all_cells();
  run(config_, true);
  int last = 0;
  std::map<std::string, std::size_t> kept;
  for (const json& cell : before) {
    kept[cell["name"]] = cell["repetitions"].size();
    for (const json& one : cell["repetitions"]) last = std::max(last, one["round"].get<int>());
  }
  for (const json& cell : all_cells()) {
    ASSERT_LT(kept[cell["name"]], 4U);
    EXPECT_EQ(cell["repetitions"][kept[cell["name"]]]["round"], last + 1);
  }
}

TEST_F(Resume, ResultsThatDifferFromBeforeAreAMismatch) {
  run(config_);
  const std::vector<std::string> lines = log();
  write_log(std::span(lines).first(9));
  fault_ = [](const Traced& traced) { drop_one_hit(traced.buffer); };
  EXPECT_EQ(run(config_, true).failed, 1U);
  const json faulty = cells().at("faulty");
  EXPECT_EQ(faulty["row"]["verdict"], "mismatch");
  EXPECT_TRUE(
      scenes::says(faulty["message"].get<std::string>(), {"different hits than the first"}));
  expect_times(faulty, false);
}

/// If it were forgotten, a time of wrong hits would remain.
TEST_F(Resume, AWrongRepetitionIsNotForgotten) {
  for (const int wrong : {1, 2, 3, 5}) {
    std::filesystem::remove_all(results());
    bool is_wrong = false;
    const int before = traces_;
    fault_ = [&](const Traced& traced) {
      if (traces_ - before - 1 != wrong) return;
      drop_one_hit(traced.buffer);
      is_wrong = true;
    };
    SweepOptions options;
    options.before_each_piece = [&] {
      if (is_wrong) throw SweepStopped();
    };
    EXPECT_THROW(run(config_, options), SweepStopped) << wrong;
    fault_ = [](const Traced&) {};
    EXPECT_EQ(run(config_, true).failed, 1U) << wrong;
    EXPECT_EQ(cells().at("faulty")["row"]["verdict"], "mismatch") << wrong;
  }
}

TEST_F(Resume, RefusesAChangedConfiguration) {
  run(config_);
  json changed = config_;
  changed["precision"] = 0.5;
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { run(changed, true); }),
                           {"cannot resume", "configuration", "/precision"}));
}

TEST_F(Resume, RefusesAnotherBuildOrScene) {
  run(config_);
  const std::vector<std::string> lines = log();
  write_changed(lines, "header", "/manifest/program/executable_hash", "0");
  EXPECT_TRUE(
      scenes::says(scenes::thrown_message([&] { run(config_, true); }), {"different sources"}));
  write_changed(lines, "header", "/manifest/scenes/0/hash", "0");
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { run(config_, true); }),
                           {"tetra:n=2", "has changed"}));
}

TEST_F(Resume, RefusesModifiedRecords) {
  struct Change {
    const char* kind;
    const char* pointer;
    json value;
  };
  run(config_);
  const std::vector<std::string> lines = log();
  for (const auto& [kind, pointer, value] :
       {Change{"cell", "/ray_set", json::array({1})}, Change{"cell", "/scene", 7},
        Change{"cell", "/ray_set/rays", "many"}, Change{"repetition", "/trace_ms", "fast"},
        Change{"repetition", "/index", "first"}, Change{"verification", "/agree", json::array()},
        Change{"finished", "/examples", 1}, Change{"header", "/plan", json::array({1})},
        Change{"header", "/manifest/plugins", json::array({1})},
        Change{"header", "/manifest/scenes", json::array({1})},
        Change{"header", "/manifest/run_id", json::array({1})}}) {
    write_changed(lines, kind, pointer, value);
    EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { run(config_, true); }),
                             {"run/run.jsonl", "not as it was written", "-o"}))
        << kind << pointer;
  }
  write_log({}, std::string(400'000, '[') + '\n');
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { run(config_, true); }),
                           {"run/run.jsonl, line 1", "64 levels"}));
  write_log(lines);
  EXPECT_EQ(run(config_, true).cells, 2U);
}

TEST_F(Resume, ANewRunDoesNotOverwriteAnOldOne) {
  run(config_);
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { run(config_); }),
                           {"already holds a run", "--resume"}));
}

}  // namespace
}  // namespace beambench::measure

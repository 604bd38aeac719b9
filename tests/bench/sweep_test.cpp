// Whole sweeps over tiny scenes: what is right keeps its times, what is wrong loses them, and what
// is finished is not repeated.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <span>
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
#include "harness/bench/sweep_run.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::bench {
namespace {

using nlohmann::json;

/// A trace that a broken structure spoils.
struct Traced {
  accel::HitBuffer& buffer;        ///< with the right hits
  const accel::HitBuffer& before;  ///< what was in it before
  int pass;  ///< counts the traces: the counting one is 0, the two of repetition n 2n - 1 and 2n
};
using Fault = std::function<void(const Traced&)>;

/// `exhaustive` with a fault.
class FaultyAccelerator : public accel::Accelerator {
 public:
  FaultyAccelerator(const scenes::Scene& scene, Fault fault, std::shared_ptr<int> passes)
      : right_(accel::registry().choose({"exhaustive", {}}).build(scene)),
        fault_(std::move(fault)),
        passes_(std::move(passes)) {}

  std::optional<accel::Hit> closest_hit(const accel::Ray& ray,
                                        accel::WorkCounters* counters) const override {
    return right_->closest_hit(ray, counters);
  }
  bool any_hit(const accel::Ray& ray, accel::WorkCounters* counters) const override {
    return right_->any_hit(ray, counters);
  }
  void trace(const accel::PrimaryRays& rays, accel::HitBuffer& buffer,
             accel::WorkCounters* counters) const override {
    const accel::HitBuffer before = buffer;
    right_->trace(rays, buffer, counters);
    fault_({buffer, before, (*passes_)++});
  }
  void closest_hits(const accel::RayBatch& batch, accel::HitBuffer& buffer,
                    accel::WorkCounters* counters) const override {
    right_->closest_hits({batch}, buffer, counters);
  }
  void any_hits(const accel::RayBatch& batch, std::span<std::uint8_t> hits,
                accel::WorkCounters* counters) const override {
    right_->any_hits({batch}, hits, counters);
    hits.front() = hits.front() == 0 ? 1 : 0;  // its fault with any-hit queries
  }
  accel::Statistics statistics() const override { return right_->statistics(); }

 private:
  std::unique_ptr<accel::Accelerator> right_;
  Fault fault_;
  std::shared_ptr<int> passes_;
};

void drop_one_hit(accel::HitBuffer& buffer) { buffer.set(buffer.index(16, 10, 0), std::nullopt); }

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

  SweepOutcome run(const json& document, bool resume = false) {
    SweepOptions options;
    options.resume = resume;
    return run(document, std::move(options));
  }
  SweepOutcome run(const json& document, SweepOptions options) {
    const SweepConfig sweep = read_sweep(folder_.write("sweep.json", document.dump()), structures_);
    options.folder = results();
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> messages(
        std::fopen((folder_.path() / "messages").c_str(), "w"), std::fclose);
    return run_sweep(sweep, make_plan(sweep), GoogleBenchmark(BenchmarkFlags()), options,
                     messages.get());
  }

  std::filesystem::path results() const { return folder_.path() / "run"; }
  std::string messages() const { return read_text(folder_.path() / "messages"); }
  json read_json(const std::string& name) const { return json::parse(read_text(results() / name)); }
  /// The cells by the bare name of their structure.
  std::map<std::string, json> cells() const {
    std::map<std::string, json> found;
    for (const auto& entry : std::filesystem::directory_iterator(results() / "cells")) {
      json cell = json::parse(read_text(entry.path()));
      found[cell["row"]["structure"].get<std::string>()] = cell;
    }
    return found;
  }

  accel::Registry structures_;
  TemporaryFolder folder_;
};

/// Intervals aside: four repetitions have none. A quick trace may have nothing beyond the
/// harness's.
bool is_time(const std::string& column) {
  return column.find("_ms_") != std::string::npos && column.find("_ci_") == std::string::npos &&
         column != "trace_net_ms_median";
}

void expect_times(const json& cell, bool has_times) {
  for (const auto& [column, value] : cell["row"].items()) {
    if (!is_time(column)) continue;
    EXPECT_EQ(value.is_number(), has_times) << column << " of " << cell["name"];
  }
  EXPECT_EQ(cell["repetitions"].empty(), !has_times);
}

TEST_F(Sweep, RightStructuresKeepTheirTimes) {
  const SweepOutcome outcome =
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
  run(config({"null", "exhaustive"}));
  const json row = cells()["exhaustive"]["row"];
  EXPECT_GT(row["harness_ms"], 0.0);
  EXPECT_EQ(row["trace_net_ms_median"],
            row["trace_ms_median"].get<double>() - row["harness_ms"].get<double>());
  EXPECT_TRUE(cells()["null"]["row"]["trace_net_ms_median"].is_null());
  EXPECT_TRUE(scenes::says(messages(), {"harness overhead: at most"}));
}

TEST_F(Sweep, EachQueryPathHasAShareOfItsOwn) {
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
  const json overhead = read_json("manifest.json")["harness_overhead"];
  EXPECT_TRUE(overhead["by_query_path"].contains("image-single"));
  EXPECT_FALSE(overhead["by_query_path"].contains("image-own"));
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

/// The resident memory of this process, in bytes; 0 where the system does not say.
std::uint64_t resident_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::uint64_t kibibytes = 0;
    if (word == "VmRSS:" && status >> kibibytes) return 1024 * kibibytes;
  }
  return 0;
}

/// A cell took 20 kB or more, for as long as the run went on, and at its end as much again.
TEST_F(Sweep, MemoryDoesNotGrowWithTheCells) {
  json document = config({"null", "exhaustive"});
  document["scenes"] = {"tetra:n=1"};
  document["repetitions"] = {{"minimum", 12}, {"maximum", 12}};
  document["resolutions"] = json::array();
  for (int width = 1; width <= 150; ++width) {
    document["resolutions"].push_back(fmt::format("{}x1", width));
  }
#ifdef __GLIBC__
  malloc_trim(0);  // what earlier tests of this process have freed would hide growth
#endif
  std::vector<std::uint64_t> resident;
  SweepOptions options;
  options.before_each_piece = [&] { resident.push_back(resident_bytes()); };
  EXPECT_EQ(run(document, options).cells, 300U);
  if (resident.front() == 0) GTEST_SKIP() << "the system does not say how much memory is used";
  const std::uint64_t early = resident[resident.size() / 10];
  constexpr std::uint64_t kMost = std::uint64_t{3} << 20U;  // 10 kB for each of the other cells
  EXPECT_LT(resident.back(), early + kMost) << "as the last cell is measured";
  EXPECT_LT(resident_bytes(), early + kMost) << "at the end";
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

/// So that a slow half of a minute meets some repetitions of each view, not all of one.
TEST_F(Sweep, ViewsOfASceneTakeTurns) {
  std::vector<std::size_t> rays;  // of each trace
  add_faulty([&](const Traced& traced) { rays.push_back(traced.buffer.size()); });
  json document = config({"faulty"});
  document["resolutions"] = {"4x4", "8x4", "8x8"};
  document["repetitions"]["second_traces"] = 1;
  run(document);
  constexpr std::size_t kViews = 3;
  constexpr std::size_t kRepetitions = 4;
  constexpr std::size_t kExtra = 2;  // the counting pass, and the trace after the first repetition
  ASSERT_EQ(rays.size(), kViews * (kRepetitions + kExtra));
  const std::set<std::size_t> all{16, 32, 64};
  const std::span later = std::span(rays).last(kViews * (kRepetitions - 1));
  for (std::size_t first = 0; first < later.size(); first += kViews) {
    const auto round = later.subspan(first, kViews);
    EXPECT_EQ(std::set(round.begin(), round.end()), all) << "round " << 1 + first / kViews;
  }
}

/// Rays of several views are in memory together, so they are few; and no more than eight views, so
/// that an interrupted run loses little.
TEST_F(Sweep, NoMoreThanEightViewsTakeTurns) {
  std::vector<std::size_t> rays;
  add_faulty([&](const Traced& traced) { rays.push_back(traced.buffer.size()); });
  json document = config({"faulty"});
  document["resolutions"] = json::array();
  for (int width = 1; width <= 10; ++width) {
    document["resolutions"].push_back(fmt::format("{}x1", width));
  }
  run(document);
  const auto at_most = [&](std::size_t most) {
    return std::is_partitioned(rays.begin(), rays.end(), [&](std::size_t n) { return n <= most; });
  };
  EXPECT_FALSE(at_most(7)) << "the eighth view waits for the seventh to end";
  EXPECT_TRUE(at_most(8)) << "the ninth view does not wait for the eighth to end";
}

/// A fault in the hits, and what the message says of it.
struct Planted {
  const char* name;
  Fault fault;
  const char* words;
};

class PlantedSweepFault : public Sweep, public testing::WithParamInterface<Planted> {};

TEST_P(PlantedSweepFault, LosesItsTimesAndNobodyElses) {
  add_faulty(GetParam().fault);
  const SweepOutcome outcome = run(config({"faulty", "exhaustive"}));
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
                            "repetition 3 wrote other hits"},
                    Planted{"AnotherAnswerInASecondTrace",
                            [](const Traced& traced) {
                              if (traced.pass == 4) drop_one_hit(traced.buffer);
                            },
                            "a second trace of the same structure"},
                    Planted{"AnotherAnswerWhileCounting",
                            [](const Traced& traced) {
                              if (traced.pass == 0) drop_one_hit(traced.buffer);
                            },
                            "the counting pass found other hits"}),
    [](const auto& planted) { return planted.param.name; });

TEST_F(Sweep, TracesEveryKindOfRays) {
  json all = config({"exhaustive", "samet:max_level=4", "embree"});
  all["rays"] = {"primary",      "shadow", "reflection", "diffuse:seed=3",
                 "ao:samples=2", "path",   "random"};
  EXPECT_EQ(run(all).failed, 0U);
  std::map<std::string, std::set<json>> hashes;
  for (const auto& entry : std::filesystem::directory_iterator(results() / "cells")) {
    const json row = json::parse(read_text(entry.path()))["row"];
    const std::string kind = row["ray_kind"];
    hashes[kind].insert(row["rays_hash"]);
    const bool any_hit = kind == "shadow" || kind == "ao:samples=2";
    EXPECT_EQ(row["query"], any_hit ? "any" : "closest");
    EXPECT_EQ(row["hit_share"].is_null(), any_hit);
    EXPECT_EQ(row["occluded_share"].is_null(), !any_hit);
    const json share = any_hit ? row["occluded_share"] : row["hit_share"];
    EXPECT_EQ(share.get<double>(), row["hits"].get<double>() / row["rays"].get<double>());
    const bool seeded = any_hit ? kind != "shadow" : kind == "random" || kind == "path";
    EXPECT_EQ(row["seed"], kind == "diffuse:seed=3" ? 3 : seeded ? 1 : 0);
    EXPECT_LE(row["coherence"].get<double>(), 1.0);
  }
  EXPECT_EQ(hashes.size(), 7U);
  for (const auto& [kind, of_kind] : hashes) EXPECT_EQ(of_kind.size(), 1U) << kind;
}

TEST_F(Sweep, DrawsWholePictures) {
  json whole = config({"null", "exhaustive", "samet:max_level=4", "beam", "embree"});
  whole["scenes"] = {"balls:n=1"};
  whole["rays"] = {"whitted"};
  const SweepOutcome outcome = run(whole);
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

TEST_F(Sweep, RaysThatASceneHasNoneOfAreRowsThatSaySo) {
  const auto dark = folder_.write("dark.nff",
                                  "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\n"
                                  "resolution 8 8\nf 1 0 0 1 0 0 0 0\ns 0 0 0 1\n");
  json config = this->config({"exhaustive"});
  config["scenes"] = {dark.string()};
  config["structures"] = {"exhaustive", "samet"};
  config["rays"] = {"shadow", "primary"};
  const SweepOutcome outcome = run(config);
  EXPECT_EQ(outcome.cells, 4U);
  EXPECT_EQ(outcome.failed, 0U);
  EXPECT_EQ(outcome.without_rays, 2U);
  EXPECT_TRUE(scenes::says(messages(), {"has no lights"}));
  EXPECT_TRUE(scenes::says(messages(), {"primary/exhaustive: build"}));

  // A record of these rays alone has the rows, too.
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

TEST_F(Sweep, WarnsOfRaysThatNeverHit) {
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
  const SweepOutcome outcome = run(config({"samet:max_level=8,max_references=1", "exhaustive"}));
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
    add_faulty([this](const Traced&) { ++traces_; });  // right, and counted
  }
  json config_ = config({"faulty", "exhaustive"});
  int traces_ = 0;
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
  EXPECT_EQ(run(config_, true).cells, 2U) << "what was written is read";
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

TEST_F(Resume, MakesUpForTheCellThatIsMissing) {
  run(config_);
  const std::string run_id = read_json("manifest.json")["run_id"];
  const json exhaustive = cells()["exhaustive"];
  const auto missing = cells()["faulty"]["key"].get<std::string>() + ".json";
  std::filesystem::remove(results() / "cells" / missing);
  traces_ = 0;
  EXPECT_EQ(run(config_, true).cells, 2U);
  EXPECT_EQ(traces_, 9);
  EXPECT_EQ(cells()["exhaustive"], exhaustive);
  EXPECT_EQ(cells()["faulty"]["row"]["run_id"], run_id);
  EXPECT_EQ(read_json("google-benchmark.json")["benchmarks"].size(), 8U);
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
  const json manifest = read_json("manifest.json");
  json changed = manifest;
  changed["program"]["executable_hash"] = "0";
  folder_.write("run/manifest.json", changed.dump());
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { run(config_, true); }), {"another build"}));
  changed = manifest;
  changed["scenes"][0]["hash"] = "0";
  folder_.write("run/manifest.json", changed.dump());
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { run(config_, true); }),
                           {"tetra:n=2", "has changed"}));
}

TEST_F(Resume, RefusesRecordsThatAreNotAsTheyWereWritten) {
  run(config_);
  const std::string cell = "run/cells/" + cells()["faulty"]["key"].get<std::string>() + ".json";
  const json whole = cells()["faulty"];
  for (const auto& [pointer, value] :
       std::initializer_list<std::pair<const char*, json>>{{"/row", json::array({1})},
                                                           {"/row/scene", 7},
                                                           {"/row/rays", "many"},
                                                           {"/row/trace_ms_median", "fast"},
                                                           {"/index", "first"},
                                                           {"/repetitions", json::array({1})}}) {
    json changed = whole;
    changed[json::json_pointer(pointer)] = value;
    folder_.write(cell, changed.dump());
    EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { run(config_, true); }),
                             {cell, "not as it was written", "remove"}))
        << pointer;
  }
  folder_.write(cell, whole.dump());
  const json manifest = read_json("manifest.json");
  for (const char* member : {"plugins", "scenes", "run_id"}) {
    json changed = manifest;
    changed[member] = json::array({1});
    folder_.write("run/manifest.json", changed.dump());
    EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { run(config_, true); }),
                             {"run/manifest.json", "not as it was written", "-o"}))
        << member;
  }
  folder_.write("run/manifest.json", std::string(400'000, '['));
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { run(config_, true); }),
                           {"run/manifest.json", "64 levels", "-o"}));
  folder_.write("run/manifest.json", manifest.dump());
  EXPECT_EQ(run(config_, true).cells, 2U);
}

TEST_F(Resume, ANewRunDoesNotOverwriteAnOldOne) {
  run(config_);
  EXPECT_TRUE(scenes::says(scenes::thrown_message([&] { run(config_); }),
                           {"already holds a run", "--resume"}));
}

}  // namespace
}  // namespace beambench::bench

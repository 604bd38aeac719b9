// A CPU quota: its entry in the record of a run, and the warnings about it.

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "accel/core/registry.hpp"
#include "harness/analysis/exports.hpp"
#include "harness/analysis/words.hpp"
#include "harness/measure/record/conditions.hpp"
#include "harness/measure/record/joined_manifest.hpp"
#include "harness/measure/record/manifest.hpp"
#include "harness/measure/record/run_log.hpp"
#include "harness/measure/sweep_run.hpp"
#include "tests/fake_system.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::measure {
namespace {

using Json = nlohmann::ordered_json;

TEST(CpuQuota, BelowTheNumberOfThreadsIsAWarning) {
  EXPECT_TRUE(scenes::says(quota_warning(0.2, 1).value_or(""), {"0.2 CPUs", "1 thread can use"}));
  EXPECT_TRUE(scenes::says(quota_warning(1.5, 2).value_or(""), {"1.5 CPUs", "2 threads can use"}));
  EXPECT_FALSE(quota_warning(2.0, 2));
  EXPECT_FALSE(quota_warning(std::nullopt, 64));
}

TEST(CpuQuota, IsInTheManifest) {
  const auto manifest = [](const FakeSystem& system) {
    return begin_manifest("test", {}, -1, 1, std::chrono::seconds(0), {}, system.root());
  };
  const auto warns_of_quota = [](const Manifest& manifest) {
    return std::ranges::any_of(manifest.uncontrolled, [](const std::string& sentence) {
      return sentence.find("quota of 0.2 CPUs") != std::string::npos;
    });
  };
  const FakeSystem system;
  const Manifest without = manifest(system);
  EXPECT_TRUE(to_json(without)["machine"].at("cpu_quota").is_null());
  EXPECT_TRUE(to_json(without)["measurement"].at("throttling").is_null());
  EXPECT_FALSE(warns_of_quota(without));
  system.join_group("/a");
  system.write("sys/fs/cgroup/a/cpu.max", "20000 100000\n");
  const Manifest with = manifest(system);
  EXPECT_EQ(to_json(with)["machine"].at("cpu_quota"), 0.2);
  EXPECT_TRUE(warns_of_quota(with));
  EXPECT_TRUE(scenes::says(preflight(with).front(), {"cores (quota: 0.2 CPUs)"}));
  EXPECT_EQ(preflight(without).front().find("quota"), std::string::npos);
}

TEST(Throttling, OfShardsIsSummed) {
  const auto shard = [](int number, std::optional<Throttling> throttling) {
    Manifest manifest = begin_manifest("test", {}, -1, 1, std::chrono::seconds(0));
    manifest.finished_utc = manifest.begun_utc;
    manifest.shard = ShardFacts{};
    manifest.shard->shard = {number, 3};
    manifest.measurement.throttling = throttling;
    return to_json(manifest);
  };
  const std::vector<Json> shards{shard(1, Throttling{10, 4, 0.5}), shard(2, std::nullopt),
                                 shard(3, Throttling{4, 1, 0.25})};
  EXPECT_EQ(conditions_of(joined_manifest(shards)).throttling, (Throttling{14, 5, 0.75}));
  EXPECT_EQ(conditions_of(joined_manifest(std::span(shards).subspan(1, 1))).throttling,
            std::nullopt);
}

/// Ends a run like Ctrl-C.
struct CutOff : std::runtime_error {
  CutOff() : std::runtime_error("cut off") {}
};

/// Sweeps of a few quick cells on a system with a quota that throttles the process once for each
/// piece of work.
class ThrottledSweep : public testing::Test {
 protected:
  ThrottledSweep() { system_.join_group("/a"); }

  /// Runs the sweep. An interrupted run is not analyzed.
  analysis::Analysis run(bool resume, std::optional<int> last_piece = std::nullopt) {
    const std::filesystem::path file = system_.root() / "sweep.json";
    system_.write("sweep.json",
                  R"({"name": "test", "scenes": ["tetra:n=2", "balls:n=1", "escena1"],
                      "structures": ["exhaustive"], "resolutions": ["32x20"], "precision": 0,
                      "repetitions": {"minimum": 1, "maximum": 1}, "budget_seconds": 1,
                      "warm_up_seconds": 0})");
    const SweepConfig sweep = read_sweep(file, accel::registry());
    SweepOptions options;
    options.folder = folder();
    options.resume = resume;
    options.root = system_.root();
    options.before_each_piece = [&, pieces = 0]() mutable {
      if (last_piece && ++pieces > *last_piece) throw CutOff();
      throttled_ += 1;
      system_.count_throttling("/a", 2 * throttled_, throttled_);
    };
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> messages(
        std::fopen((system_.root() / "messages").c_str(), "w"), std::fclose);
    return analysis::conclude(run_sweep(sweep, make_plan(sweep), GoogleBenchmark(BenchmarkFlags()),
                                        options, messages.get()));
  }

  std::filesystem::path folder() const { return system_.root() / "run"; }
  Json manifest() const { return Json::parse(read_text(folder() / "manifest.json")); }
  /// Returns the number of throttled periods in the log, which interrupted runs also record.
  int recorded() const {
    return static_cast<int>(
        conditions_of(read_run(folder()).manifest).throttling.value().throttled);
  }
  std::string messages() const { return read_text(system_.root() / "messages"); }

  FakeSystem system_;
  int throttled_ = 0;
};

TEST_F(ThrottledSweep, IsReportedInSummaryAndManifest) {
  system_.write("sys/fs/cgroup/a/cpu.max", "20000 100000\n");
  system_.count_throttling("/a", 70, 50);  // before the run
  throttled_ = 50;
  const std::string summary = analysis::summary(run(false));
  EXPECT_EQ(recorded(), throttled_ - 50);
  EXPECT_EQ(manifest()["measurement"]["throttling"]["throttled_periods"], recorded());
  const std::string words = "the kernel throttled the process in " + std::to_string(recorded());
  EXPECT_TRUE(scenes::says(summary, {words}));
  EXPECT_TRUE(scenes::says(manifest().at("uncontrolled").dump(), {words}));
  EXPECT_TRUE(scenes::says(messages(), {"warning: The process has a quota of 0.2 CPUs"}));
}

TEST_F(ThrottledSweep, ThatIsResumedSumsItsParts) {
  system_.count_throttling("/a", 0, 0);
  EXPECT_THROW(run(false, 7), CutOff);
  const int first = recorded();
  EXPECT_GT(first, 0) << "the finished cells were throttled";
  throttled_ = 1000;
  system_.count_throttling("/a", 2000, 1000);  // between the parts
  run(true);
  EXPECT_EQ(recorded(), first + throttled_ - 1000);
}

TEST_F(ThrottledSweep, WithoutControlGroupsIsLikeAnyOther) {
  std::filesystem::remove_all(system_.root() / "proc");
  const std::string summary = analysis::summary(run(false));
  EXPECT_TRUE(manifest().at("measurement").at("throttling").is_null());
  EXPECT_EQ(summary.find("throttled"), std::string::npos);
}

}  // namespace
}  // namespace beambench::measure

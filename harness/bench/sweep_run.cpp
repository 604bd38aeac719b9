#include "harness/bench/sweep_run.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "harness/base/counted.hpp"
#include "harness/base/progress.hpp"
#include "harness/bench/measurement.hpp"
#include "harness/bench/overhead.hpp"
#include "harness/bench/plan.hpp"
#include "harness/bench/record/manifest.hpp"
#include "harness/bench/record/run_folder.hpp"
#include "harness/bench/task.hpp"
#include "harness/bench/turns.hpp"
#include "harness/rays/fingerprint.hpp"
#include "scenes/core/error.hpp"

namespace beambench::bench {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

/// Above this part of the fastest contender's time the harness's own is worth a sentence.
constexpr double kWantedOverhead = 0.02;

/// The core to pin to, or -1 where pinning does not work.
int pinnable_core() {
  const int core = present_core();
  return PinnedThread(core).pinned() ? core : -1;
}

/// `35.1 ms [34.9, 35.6]`: a median, and its interval where there is one.
std::string with_interval(const Row& row, const std::string& name) {
  std::string text = fmt::format("{:.4g} ms", row.at(name + "_ms_median").get<double>());
  const Json& low = row.at(name + "_ms_ci_low");
  if (low.is_null()) return text;
  return fmt::format("{} [{:.4g}, {:.4g}]", text, low.get<double>(),
                     row.at(name + "_ms_ci_high").get<double>());
}

/// `build 1.23 ms, trace 35.1 ms [34.9, 35.6], second trace 34.0 ms [33.8, 34.3], 37.0 Mrays/s, ok
/// after 12 repetitions (precision)`.
std::string result_line(const CellRecord& cell, const Row& row) {
  if (!cell.keeps_times()) return fmt::format("{}: {}", cell.verdict, cell.message);
  return fmt::format("build {:.4g} ms, trace {}, second trace {}, {:.4g} Mrays/s, {} after {} ({})",
                     row.at("build_ms_median").get<double>(), with_interval(row, "trace"),
                     with_interval(row, "trace_warm"),
                     row.at("mrays_per_s").is_null() ? 0.0 : row.at("mrays_per_s").get<double>(),
                     cell.verdict, base::counted(cell.repetitions.size(), "repetition"),
                     to_string(*cell.stop_reason));
}

/// A group's name without what is at its default.
std::string shown(const CellGroup& group) {
  std::string name = group.name();
  return name.replace(0, group.scene->name.size(), shown_scene(group.scene->name));
}

class SweepRun {
 public:
  SweepRun(const SweepConfig& config, Plan plan, const GoogleBenchmark& benchmark,
           const SweepOptions& options, std::FILE* messages)
      : config_(config),
        benchmark_(benchmark),
        options_(options),
        messages_(messages),
        core_(config.threads == 1 ? pinnable_core() : -1),
        manifest_(
            begin_manifest(config.name, scene_facts(plan), core_, config.threads, config.warm_up)),
        folder_(open_folder()),
        plan_(unfinished(std::move(plan))) {}

  SweepOutcome run() && {
    {
      const PinnedThread pin(core_);
      manifest_.measurement.noise = warm_up(config_.warm_up);
    }
    if (const auto warning = noise_warning(manifest_.measurement.noise)) {
      manifest_.uncontrolled.push_back(*warning);
    }
    manifest_.measurement.hardware_problem = counters_.problem();
    for (const std::string& line : preflight(manifest_)) fmt::print(messages_, "{}\n", line);
    folder_.write_json("manifest.json", to_json(manifest_));
    if (options_.begun) options_.begun(folder_.path());
    const auto begin = Clock::now();
    std::size_t cells_left = plan_.cell_count();
    base::Progress progress(cells_left, messages_);
    cells_left -= give_up_broken(progress);
    for (CellGroup& group : plan_.groups) {
      const double left_ms = 1e3 * config_.budget_seconds - elapsed_ms(begin);
      const double share_ms = std::max(left_ms, 0.0) / static_cast<double>(cells_left);
      cells_left -= group.cells.size();
      run_group(group, share_ms, progress);
      group.scene.reset();
    }
    return close();
  }

 private:
  static double elapsed_ms(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  }

  RunFolder open_folder() {
    if (options_.resume) return reopen_folder();
    RunFolder folder = RunFolder::create(
        options_.folder.value_or(std::filesystem::path("results") / "runs" / manifest_.run.run_id));
    folder.write_json("config.json", config_.source);
    return folder;
  }

  RunFolder reopen_folder() {
    RunFolder folder = RunFolder::open(options_.folder.value());
    require_same_run(folder, config_.source, to_json(manifest_));
    go_on(manifest_, folder.read_json("manifest.json"));
    folder.write_results();
    return folder;
  }

  Plan unfinished(Plan plan) const {
    filter_cells(plan, [&](const CellId& id) { return !folder_.has_cell(id.key()); });
    return plan;
  }

  /// Records the cells that broke an earlier process down; how many there are.
  std::size_t give_up_broken(base::Progress& progress) {
    const auto& broken = options_.broken_cells;
    std::size_t count = 0;
    for (const CellGroup& group : plan_.groups) {
      for (const PlannedCell& cell : group.cells) {
        const auto found = broken.find(cell.id.key());
        if (found == broken.end()) continue;
        finish(unmeasured_cell(group, cell, "error", found->second), progress);
        ++count;
      }
    }
    filter_cells(plan_, [&](const CellId& id) { return !broken.contains(id.key()); });
    return count;
  }

  void run_group(const CellGroup& group, double share_ms, base::Progress& progress) {
    const auto begin = Clock::now();
    progress.start(shown(group));
    const auto give_up = [&](std::string_view verdict, const std::string& why) {
      for (const PlannedCell& cell : group.cells) {
        finish(unmeasured_cell(group, cell, verdict, why), progress);
      }
    };
    std::unique_ptr<Task> task;
    try {
      task = make_task(group, hash_of(*group.scene), core_);
    } catch (const rays::NoRaysError& error) {  // the other groups go on
      return give_up(verify::kNoRays, error.what());
    } catch (const InputError& error) {
      return give_up("error", error.what());
    }
    if (const auto warning = task->warning()) {
      warn(fmt::format("{}: {}.", shown(group), *warning), progress);
    }
    measure(group, *task, begin, share_ms, progress);
  }

  void warn(std::string sentence, base::Progress& progress) {
    progress.say("warning: " + sentence);
    manifest_.uncontrolled.push_back(std::move(sentence));
  }

  CellRecord unmeasured_cell(const CellGroup& group, const PlannedCell& cell,
                             std::string_view verdict, std::string message) const {
    CellRecord record{};
    record.index = cell.index;
    record.id = cell.id;
    record.rays.scene_hash = hash_of(*group.scene);
    record.rays.primitives = group.scene->primitives.size();
    record.time_utc = utc_now();
    record.verdict = verdict;
    record.message = std::move(message);
    return record;
  }

  void measure(const CellGroup& group, Task& task, Clock::time_point begin, double share_ms,
               base::Progress& progress) {
    const auto label = [&] { progress.start(shown(group)); };
    std::vector<Contender> contenders;
    for (const PlannedCell& cell : group.cells) {
      options_.at_work(cell.id.key());
      contenders.emplace_back(cell, task).count();
    }
    // The oracle's and the counting passes' time is the group's own.
    const auto cells = static_cast<double>(group.cells.size());
    const double allowance_ms = std::max(share_ms - elapsed_ms(begin) / cells, 0.0);
    const StoppingRule stopping{config_.precision, config_.minimum_repetitions,
                                config_.maximum_repetitions};
    const TurnRules rules{stopping, allowance_ms, rays::fingerprint(group.name())};
    take_turns(std::move(contenders), {benchmark_, counters_, core_, config_.threads}, rules,
               {[&](const Contender& contender) { options_.at_work(contender.id().key()); },
                [&](const CellRecord& cell) {
                  finish(cell, progress);
                  label();
                },
                [&](double done) { progress.advance(done); }});
    options_.at_work("");
  }

  void finish(const CellRecord& cell, base::Progress& progress) {
    const Json json = to_json(manifest_.run, cell);
    folder_.add_cell(json);
    if (!cell.keeps_times()) {
      progress.say(fmt::format("{}: {}: {}", cell.verdict, shown_name(cell.id), cell.message));
      for (const std::string& example : cell.examples) progress.say(example);
    }
    progress.start(shown_name(cell.id));
    progress.finish(result_line(cell, json.at("row")));
  }

  std::uint64_t hash_of(const scenes::Scene& scene) const {
    const auto found =
        std::find_if(manifest_.scenes.begin(), manifest_.scenes.end(),
                     [&](const SceneFacts& facts) { return facts.name == scene.name; });
    return found->hash;
  }

  SweepOutcome close() {
    const std::vector<Json> cells = folder_.cells();
    manifest_.finished_utc = utc_now();
    const std::vector<Overhead> overheads = largest_overheads(cells);
    manifest_.overhead = to_json(overheads);
    if (!overheads.empty()) fmt::print(messages_, "{}\n", describe(overheads));
    if (!overheads.empty() && overheads.front().part > kWantedOverhead) {
      manifest_.uncontrolled.push_back(fmt::format("The {}.", describe(overheads)));
    }
    folder_.write_text("google-benchmark.json", google_benchmark_json(cells, benchmark_context()));
    folder_.write_json("manifest.json", to_json(manifest_));
    SweepOutcome outcome{folder_.results(), cells.size()};
    for (const Json& cell : cells) {
      const auto verdict = cell.at("row").at("verdict").get<std::string>();
      if (verdict == verify::kNoRays) {
        ++outcome.without_rays;
      } else if (verdict != "ok" && verdict != "baseline") {
        ++outcome.failed;
      }
    }
    return outcome;
  }

  Json benchmark_context() const {
    // The host's name stays out of records; library_build_type is of Google Benchmark alone.
    return {{"host_name", manifest_.machine.id},
            {"beambench_run_id", manifest_.run.run_id},
            {"beambench_commit", manifest_.run.commit},
            {"beambench_dirty", manifest_.run.dirty},
            {"beambench_build_type", manifest_.run.build_type},
            {"beambench_isa", manifest_.run.isa}};
  }

  const SweepConfig& config_;
  const GoogleBenchmark& benchmark_;
  const SweepOptions& options_;
  std::FILE* messages_;
  int core_;
  HardwareCounters counters_;
  Manifest manifest_;
  RunFolder folder_;
  Plan plan_;
};

}  // namespace

SweepOutcome run_sweep(const SweepConfig& config, Plan plan, const GoogleBenchmark& benchmark,
                       const SweepOptions& options, std::FILE* messages) {
  return SweepRun(config, std::move(plan), benchmark, options, messages).run();
}

}  // namespace beambench::bench

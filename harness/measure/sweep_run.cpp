#include "harness/measure/sweep_run.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "harness/base/messages.hpp"
#include "harness/base/progress.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/measure/block.hpp"
#include "harness/measure/block_process.hpp"
#include "harness/measure/division.hpp"
#include "harness/measure/measurement.hpp"
#include "harness/measure/open_view.hpp"
#include "harness/measure/plan.hpp"
#include "harness/measure/record/block_statistics.hpp"
#include "harness/measure/record/conditions.hpp"
#include "harness/measure/record/machine.hpp"
#include "harness/measure/record/manifest.hpp"
#include "harness/measure/record/other_work.hpp"
#include "harness/measure/record/robust_statistics.hpp"
#include "harness/measure/record/run_log.hpp"
#include "harness/measure/tuning.hpp"
#include "harness/rays/fingerprint.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/random.hpp"

namespace beambench::measure {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the core to pin to; -1 if pinning does not work.
int pinnable_core() {
  const int core = present_core();
  return PinnedThread(core).pinned() ? core : -1;
}

/// Returns `35.1 ms [34.9, 35.6]`: a time and, if there is one, its confidence interval.
std::string with_interval(const Estimate& time) {
  const std::string text = fmt::format("{:.4g} ms", time.value);
  if (!time.confidence) return text;
  return fmt::format("{} [{:.4g}, {:.4g}]", text, time.confidence->low, time.confidence->high);
}

/// Returns `build 1.23 ms, trace 35.1 ms [34.9, 35.6], 37.0 Mrays/s, ok after 24 repetitions in 8
/// blocks (precision)`.
std::string result_line(const CellRecord& cell) {
  if (!cell.keeps_times()) return fmt::format("{}: {}", to_string(cell.verdict), cell.message);
  const std::map<int, double> blocks = trace_by_block(cell, own_clock(cell));
  if (blocks.empty()) return fmt::format("{}, too short to be timed", to_string(cell.verdict));
  std::vector<double> times;
  for (const auto& [block, time] : blocks) times.push_back(time);
  const Estimate trace = estimate(times);
  return fmt::format("build {:.4g} ms, trace {}, {:.4g} Mrays/s, {} after {} in {} ({})",
                     minimum(collect(cell, &Repetition::build_ms)), with_interval(trace),
                     1e-3 * static_cast<double>(cell.rays.rays) / trace.value,
                     to_string(cell.verdict), base::counted(cell.repetitions.size(), "repetition"),
                     base::counted(blocks.size(), "block"), to_string(*cell.stop_reason));
}

/// Returns the names of a plan's cells.
std::vector<PlannedName> names_of(const Plan& plan) {
  std::vector<PlannedName> names;
  for (const CellGroup& group : plan.groups) {
    for (const PlannedCell& cell : group.cells) names.push_back({cell.index, cell.id.name()});
  }
  return names;
}

std::optional<ShardFacts> facts_of(const std::optional<PlannedShard>& shard) {
  return shard ? std::optional(shard->facts) : std::nullopt;
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
        manifest_(begin_manifest(
            config.name, options.shard ? options.shard->scenes : scene_facts(plan), core_,
            config.threads, config.warm_up, facts_of(options.shard), options.root)),
        log_(open_log()),
        throttling_(options.root, manifest_.measurement.throttling),
        other_work_(options.root),
        names_(names_of(plan)),
        views_(unfinished(std::move(plan))),
        progress_(count_cells(), messages,
                  !options.line_per_cell && ::isatty(::fileno(messages)) == 1) {
    if (!options.resume) manifest_.google_benchmark = benchmark.context();
  }

  std::filesystem::path run() && {
    {
      const PinnedThread pin(core_);
      manifest_.measurement.noise = warm_up(config_.warm_up);
    }
    manifest_.measurement.other_work = other_work_.processors();
    if (const auto warning = noise_warning(manifest_.measurement.noise)) {
      manifest_.uncontrolled.push_back(*warning);
    }
    if (const auto other = describe_other_work(manifest_.measurement.other_work)) {
      manifest_.uncontrolled.push_back(fmt::format("Before the run, {}.", *other));
    }
    manifest_.measurement.hardware_problem = HardwareCounters().problem();
    for (const std::string& line : preflight(manifest_)) {
      base::print_message(messages_, fmt::format("{}\n", line));
    }
    if (options_.resume) {
      log_.resume(to_json(manifest_), log_bytes_);
    } else {
      log_.begin(to_json(manifest_), config_.source, names_);
    }
    options_.begun(log_.folder());
    measure();
    log_.end(utc_now(), other_work_.processors());
    return log_.folder();
  }

 private:
  RunLog open_log() {
    if (!options_.resume) {
      return RunLog::create(options_.folder.value_or(std::filesystem::path("results") / "runs" /
                                                     manifest_.run.run_id));
    }
    RunLog log = RunLog::open(options_.folder.value());
    Run run = read_run(log.folder());
    log_bytes_ = run.log_bytes;
    require_same_run(log.folder(), run, config_.source, to_json(manifest_));
    read_as_written((log.folder() / kLogName).string(), "begin a new run with -o",
                    [&] { continue_with(manifest_, run.manifest); });
    for (const PlannedName& cell : run.passed_over) finished_.insert(cell.index);
    for (CellRecord& cell : run.cells) {
      if (cell.is_finished) {
        finished_.insert(cell.index);
      } else {
        unfinished_.emplace(cell.index, std::move(cell));
      }
    }
    return log;
  }

  /// Returns a cell's record from an earlier part of the run, if the cell was begun there. Cells
  /// with wrong results are verified again.
  CellRecord earlier(const PlannedCell& cell) {
    auto found = unfinished_.extract(cell.index);
    if (found && verify::is_right(found.mapped().verdict)) return std::move(found.mapped());
    CellRecord record{};
    record.index = cell.index;
    record.id = cell.id;
    return record;
  }

  /// A cell gets the same time in a shard as in a run of the whole sweep.
  double budget_seconds() const {
    if (!manifest_.shard) return config_.budget_seconds;
    return config_.budget_seconds * static_cast<double>(manifest_.shard->cells) /
           static_cast<double>(manifest_.shard->cells_of_sweep);
  }

  /// Returns the views, with only their unfinished cells.
  std::vector<OpenView> unfinished(Plan plan) {
    std::vector<OpenView> views;
    for (CellGroup& group : plan.groups) {
      OpenView open;
      open.blocks = limits_.maximum;
      for (PlannedCell& cell : std::exchange(group.cells, {})) {
        if (finished_.contains(cell.index)) continue;
        CellRecord record = earlier(cell);
        for (const Repetition& one : record.repetitions) {
          open.blocks_made = std::max(open.blocks_made, one.block + 1);
        }
        open.cells.push_back({std::move(cell), std::move(record)});
      }
      open.view = std::move(group);
      if (!open.cells.empty()) views.push_back(std::move(open));
    }
    return views;
  }

  std::size_t count_cells() const {
    std::size_t cells = 0;
    for (const OpenView& open : views_) cells += open.cells.size();
    return cells;
  }

  /// Measures the first block of each view, which shows how many blocks the view needs and how many
  /// there is time for. Then measures the other blocks in passes over all views, so that each
  /// view's blocks are spread over the whole run.
  void measure() {
    const base::Stopwatch watch;
    for (OpenView& open : views_) {
      for (bool is_sorted : {false, true}) tune(open, is_sorted);
      const base::Stopwatch block_watch;
      run_block(open);
      open.block_ms = block_watch.milliseconds();
    }
    finish_complete();
    plan_blocks(views_, limits_, config_, 1e3 * budget_seconds() - watch.milliseconds());
    finish_complete();
    int passes = 1;
    for (const OpenView& open : views_) passes = std::max(passes, open.blocks);
    Random random(rays::fingerprint(manifest_.run.run_id));
    for (int pass = 1; !views_.empty(); ++pass) {
      const double part = std::min(1.0, static_cast<double>(pass) / std::max(passes - 1, 1));
      shuffle(views_, random);
      for (OpenView& open : views_) {
        if (blocks_done(open, limits_) <= part * (open.blocks - 1)) run_block(open);
      }
      finish_complete();
    }
  }

  /// Chooses the parameter sets of tuned contenders: if a contender has more than `kMeasuredSets`,
  /// only the fastest stay. A resumed run therefore does not tune again. A set that ends its
  /// process has no time; the others continue.
  void tune(OpenView& open, bool is_sorted) {
    std::map<std::string, std::vector<std::size_t>> contenders;
    std::vector<BlockCell> untried;
    for (const OpenCell& cell : open.cells) {
      if (cell.planned.parameter_sets == 1 || cell.planned.rays.is_sorted != is_sorted) continue;
      contenders[cell.planned.id.structure].push_back(cell.planned.index);
    }
    std::erase_if(contenders, [](const auto& each) { return each.second.size() <= kMeasuredSets; });
    for (const OpenCell& cell : open.cells) {
      const auto found = contenders.find(cell.planned.id.structure);
      if (found != contenders.end() && std::ranges::count(found->second, cell.planned.index) > 0) {
        untried.push_back({cell.planned, cell.record, 0});
      }
    }
    if (untried.empty()) return;
    progress_.start("tuning for " + open.view.shown_name());
    std::map<std::size_t, Json> found = try_candidates(open, std::move(untried));
    for (const auto& [contender, sets] : contenders) keep_fastest(open, sets, found);
  }

  /// Returns an event `candidate` for each cell.
  std::map<std::size_t, Json> try_candidates(const OpenView& open, std::vector<BlockCell> untried) {
    std::map<std::size_t, Json> found;
    const BlockWatch watch{
        [&](const Json& event) { found[event.at("index").get<std::size_t>()] = event; },
        [&](std::optional<std::size_t>) { options_.before_each_piece(); }};
    while (!untried.empty()) {
      const Block block{open.view, untried, 0, 0, 0, 1, core_, true};
      const std::optional<BrokenBlock> broken = run(block, watch);
      for (const BlockCell& each : untried) {
        const std::size_t index = each.cell.index;
        if (broken && (!broken->cell || *broken->cell == index) && !found.contains(index)) {
          found[index] = {{"event", "candidate"}, {"index", index}, {"error", broken->how}};
        }
      }
      if (!broken) break;
      std::erase_if(untried, [&](const BlockCell& c) { return found.contains(c.cell.index); });
    }
    return found;
  }

  /// Drops all parameter sets of a contender except the fastest, and records their times.
  void keep_fastest(OpenView& open, const std::vector<std::size_t>& sets,
                    const std::map<std::size_t, Json>& found) {
    std::map<std::size_t, double> times;
    Json candidates = Json::array();
    for (const OpenCell& cell : open.cells) {
      const std::size_t index = cell.planned.index;
      if (std::ranges::count(sets, index) == 0) continue;
      Json event = found.at(index);
      if (event.contains("trace_ms")) times[index] = event.at("trace_ms").get<double>();
      event["name"] = cell.planned.id.name();
      event.erase("event");
      candidates.push_back(std::move(event));
    }
    const std::vector<std::size_t> kept = fastest(times, sets);
    const scenes::Camera camera = tuning_camera(open.view.camera);
    const auto coordinates = [](const glm::vec3& v) { return Json::array({v.x, v.y, v.z}); };
    log_.add({{"event", "tuning"},
              {"view", open.view.name()},
              {"camera", {{"from", coordinates(camera.from)}, {"at", coordinates(camera.at)}}},
              {"candidates", std::move(candidates)},
              {"kept", kept}});
    const std::size_t dropped = std::erase_if(open.cells, [&](const OpenCell& cell) {
      const std::size_t index = cell.planned.index;
      return std::ranges::count(sets, index) > 0 && std::ranges::count(kept, index) == 0;
    });
    progress_.skip(dropped);
  }

  /// Measures a block of a view; measures it again if a contender ended its process.
  void run_block(OpenView& open) {
    progress_.start(open.view.shown_name());
    const int number = open.blocks_made++;
    for (std::vector<BlockCell> cells; !(cells = due(open, number, limits_)).empty();) {
      const Block block{open.view,
                        std::move(cells),
                        number,
                        next_round(open),
                        config_.second_traces,
                        options_.tries,
                        core_};
      log_.begin_block(open.view.name(), number, other_work_.processors());
      const BlockWatch watch{[&](const Json& event) { take(open, event); },
                             [&](std::optional<std::size_t>) {
                               options_.before_each_piece();
                               progress_.advance(work_done());
                             }};
      const std::optional<BrokenBlock> broken = run(block, watch);
      for (OpenCell& cell : open.cells) {
        if (broken && (!broken->cell || *broken->cell == cell.planned.index)) {
          fail(open, cell, broken->how);
        } else if (!broken && lacking(open, cell, number, limits_) > 0) {
          fail(open, cell, "the process of its block ended before all repetitions were made");
        }
      }
      if (!broken) break;
    }
    std::erase_if(open.cells, [](const OpenCell& cell) { return cell.record.is_finished; });
    finish_if_complete(open);
    log_throttling();
  }

  std::optional<BrokenBlock> run(const Block& block, const BlockWatch& watch) {
    if (!options_.block_program.empty()) {
      return measure_in_process(block, options_.block_program, watch);
    }
    measure_here(block, benchmark_, watch);
    return std::nullopt;
  }

  /// Records an event of a block.
  void take(OpenView& open, const Json& event) {
    log_.add(event);
    if (!event.contains("index")) {
      return progress_.say("warning: " + event.at("text").get<std::string>());
    }
    const auto index = event.at("index").get<std::size_t>();
    const auto cell = std::ranges::find_if(
        open.cells, [&](const OpenCell& each) { return each.planned.index == index; });
    apply(event, cell->record);
    if (cell->record.is_finished) report(cell->record);
  }

  /// Records a cell as failed because it ended the process of its block.
  void fail(const OpenView& open, OpenCell& cell, const std::string& how) {
    if (cell.record.is_finished) return;
    CellRecord& record = cell.record;
    if (!record.diff) {
      record.rays.scene_hash = open.view.scene_hash;
      record.rays.primitives = open.view.scene->primitives.size();
      events().begin_cell(record);
    }
    record.verdict = verify::Verdict::kError;
    record.message = how;
    finish(record, std::nullopt);
  }

  /// Finishes the cells of all views whose blocks are complete.
  void finish_complete() {
    for (OpenView& open : views_) finish_if_complete(open);
    std::erase_if(views_, [](const OpenView& open) { return open.cells.empty(); });
  }

  void finish_if_complete(OpenView& open) {
    const auto lacks = [&](const OpenCell& cell) {
      return lacking(open, cell, open.blocks_made, limits_) > 0;
    };
    if (std::ranges::any_of(open.cells, lacks)) return;
    for (OpenCell& cell : open.cells) finish(cell.record, open.reason);
    open.cells.clear();
  }

  CellEvents events() {
    return CellEvents([this](const Json& event) { log_.add(event); });
  }

  void finish(CellRecord& cell, std::optional<StopReason> reason) {
    cell.stop_reason = reason;
    cell.time_utc = utc_now();
    cell.is_finished = true;
    events().finish_cell(cell);
    report(cell);
  }

  void report(const CellRecord& cell) {
    if (!cell.keeps_times()) {
      progress_.say(
          fmt::format("{}: {}: {}", to_string(cell.verdict), shown_name(cell.id), cell.message));
      for (const std::string& example : cell.examples) progress_.say(example);
    }
    progress_.start(shown_name(cell.id));
    progress_.finish(result_line(cell));
  }

  /// Returns the progress of the unfinished cells, counting the finished part of each cell's
  /// blocks. It is computed at each event, possibly while a contender is timed.
  double work_done() const {
    double done = 0.0;
    for (const OpenView& open : views_) {
      const double part = static_cast<double>(open.blocks_made) / std::max(open.blocks, 1);
      done += static_cast<double>(open.cells.size()) * std::min(part, 1.0);
    }
    return done;
  }

  void log_throttling() {
    const std::optional<Throttling> total = throttling_.total();
    if (std::exchange(manifest_.measurement.throttling, total) != total && total) {
      log_.set_throttling(*total);
    }
  }

  const SweepConfig& config_;
  const BlockLimits limits_{config_};
  const GoogleBenchmark& benchmark_;
  const SweepOptions& options_;
  std::FILE* messages_;
  int core_;
  Manifest manifest_;
  std::set<std::size_t> finished_;                ///< cells finished earlier or dropped by tuning
  std::map<std::size_t, CellRecord> unfinished_;  ///< cells begun earlier
  std::uint64_t log_bytes_ = 0;                   ///< bytes that the earlier part wrote
  RunLog log_;
  ThrottlingWatch throttling_;
  OtherWork other_work_;
  std::vector<PlannedName> names_;  ///< the names of all cells
  std::vector<OpenView> views_;
  base::Progress progress_;
};

}  // namespace

std::filesystem::path run_sweep(const SweepConfig& config, Plan plan,
                                const GoogleBenchmark& benchmark, const SweepOptions& options,
                                std::FILE* messages) {
  return SweepRun(config, std::move(plan), benchmark, options, messages).run();
}

}  // namespace beambench::measure

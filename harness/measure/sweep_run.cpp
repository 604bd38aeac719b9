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

#include "harness/base/messages.hpp"
#include "harness/base/progress.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/measure/contender.hpp"
#include "harness/measure/cost.hpp"
#include "harness/measure/division.hpp"
#include "harness/measure/measurement.hpp"
#include "harness/measure/plan.hpp"
#include "harness/measure/record/conditions.hpp"
#include "harness/measure/record/machine.hpp"
#include "harness/measure/record/manifest.hpp"
#include "harness/measure/record/robust_statistics.hpp"
#include "harness/measure/record/run_log.hpp"
#include "harness/measure/task.hpp"
#include "harness/rays/fingerprint.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/random.hpp"

namespace beambench::measure {
namespace {

/// Returns the core to pin to, or -1 where pinning does not work.
int pinnable_core() {
  const int core = present_core();
  return PinnedThread(core).pinned() ? core : -1;
}

/// Returns `35.1 ms [34.9, 35.6]`: the median of times, and its interval where there is one.
std::string with_interval(const std::vector<double>& times) {
  const std::string text = fmt::format("{:.4g} ms", median(times));
  const std::optional<Interval> interval = median_interval(times);
  if (!interval) return text;
  return fmt::format("{} [{:.4g}, {:.4g}]", text, interval->low, interval->high);
}

/// Returns `build 1.23 ms, trace 35.1 ms [34.9, 35.6], second trace 34.0 ms [33.8, 34.3], 37.0
/// Mrays/s, ok after 12 repetitions (precision)`; the second trace where there was one.
std::string result_line(const CellRecord& cell) {
  if (!cell.keeps_times()) return fmt::format("{}: {}", to_string(cell.verdict), cell.message);
  const std::vector<double> trace = collect(cell, &Repetition::trace_ms);
  const std::vector<double> second = second_traces(cell);
  const double trace_us = 1e3 * median(trace);
  return fmt::format("build {:.4g} ms, trace {}, {}{:.4g} Mrays/s, {} after {} ({})",
                     median(collect(cell, &Repetition::build_ms)), with_interval(trace),
                     second.empty() ? "" : "second trace " + with_interval(second) + ", ",
                     trace_us > 0.0 ? static_cast<double>(cell.rays.rays) / trace_us : 0.0,
                     to_string(cell.verdict), base::counted(cell.repetitions.size(), "repetition"),
                     to_string(*cell.stop_reason));
}

/// Returns the cells of a plan by name.
std::vector<PlannedName> names_of(const Plan& plan) {
  std::vector<PlannedName> names;
  for (const CellGroup& group : plan.groups) {
    for (const PlannedCell& cell : group.cells) names.push_back({cell.index, cell.id.name()});
  }
  return names;
}

/// Returns a group's name without the parameters at their defaults.
std::string shown(const CellGroup& group) {
  std::string name = group.name();
  return name.replace(0, group.scene->name.size(), shown_scene(group.scene->name));
}

/// Shuffles as Fisher and Yates do, with random numbers that are the same on every machine.
template <class T>
void shuffle(std::vector<T>& values, Random& random) {
  for (std::size_t left = values.size(); left > 1; --left) {
    std::swap(values[left - 1], values[random.below(left)]);
  }
}

/// A group while it is measured.
struct OpenGroup {
  const CellGroup* group;
  std::unique_ptr<Task> task;  // to which the contenders refer
  std::vector<Contender> contenders;
};

/// Returns the number of groups from `first` that are measured together: views of one scene, few
/// enough that their rays fit into memory and that an interrupted run has little to repeat. A
/// larger one is measured alone, and one whose rays are in a file, since their number is not known
/// yet.
std::size_t batch_size(std::span<const CellGroup> groups, std::size_t first) {
  constexpr double kMaxRays = 4e6;
  constexpr std::size_t kMaxGroups = 8;
  double rays = 0.0;
  std::size_t end = first;
  for (; end < groups.size() && end - first < kMaxGroups; ++end) {
    const CellGroup& group = groups[end];
    if (group.scene != groups[first].scene || !group.rays.file.empty()) break;
    rays += estimated_rays(group);
    if (rays > kMaxRays) break;
  }
  return std::max<std::size_t>(end - first, 1);
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
        names_(names_of(plan)),
        plan_(unfinished(std::move(plan))),
        progress_(plan_.cell_count(), messages) {
    if (!options.resume) manifest_.google_benchmark = benchmark.context();
  }

  std::filesystem::path run() && {
    {
      const PinnedThread pin(core_);
      manifest_.measurement.noise = warm_up(config_.warm_up);
    }
    if (const auto warning = noise_warning(manifest_.measurement.noise)) {
      manifest_.uncontrolled.push_back(*warning);
    }
    manifest_.measurement.hardware_problem = counters_.problem();
    for (const std::string& line : preflight(manifest_)) {
      base::print_message(messages_, fmt::format("{}\n", line));
    }
    if (options_.resume) {
      log_.resume(to_json(manifest_), log_bytes_);
    } else {
      log_.begin(to_json(manifest_), config_.source, names_);
    }
    options_.begun(log_.folder());
    const base::Stopwatch watch;
    record_crashed_cells();
    std::size_t cells_left = plan_.cell_count();
    for (std::size_t first = 0; first < plan_.groups.size();) {
      const double left_ms = std::max(1e3 * budget_seconds() - watch.milliseconds(), 0.0);
      const auto batch = std::span(plan_.groups).subspan(first, batch_size(plan_.groups, first));
      run_batch(batch, left_ms / static_cast<double>(cells_left));
      for (CellGroup& group : batch) {
        cells_left -= group.cells.size();
        group.scene.reset();
        group.cells = {};  // as the record grows, the plan shrinks
      }
      first += batch.size();
    }
    log_.end(utc_now());
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
    for (CellRecord& cell : run.cells) {
      if (cell.is_finished) {
        finished_.insert(cell.index);
      } else {
        unfinished_.emplace(cell.index, std::move(cell));
      }
    }
    return log;
  }

  /// The record of a cell from an earlier part of the run.
  std::optional<CellRecord> earlier(const PlannedCell& cell) {
    auto found = unfinished_.extract(cell.index);
    return found ? std::optional(std::move(found.mapped())) : std::nullopt;
  }

  /// A cell has the same allowance in a shard as in a run of the whole sweep.
  double budget_seconds() const {
    if (!manifest_.shard) return config_.budget_seconds;
    return config_.budget_seconds * static_cast<double>(manifest_.shard->cells) /
           static_cast<double>(manifest_.shard->cells_of_sweep);
  }

  Plan unfinished(Plan plan) const {
    filter_cells(plan, [&](const PlannedCell& cell) { return !finished_.contains(cell.index); });
    return plan;
  }

  void record_crashed_cells() {
    if (options_.activity == nullptr) return;
    const auto crashed = options_.activity->crashed_cells();
    for (const CellGroup& group : plan_.groups) {
      for (const PlannedCell& cell : group.cells) {
        const auto found = crashed.find(cell.id.key());
        if (found != crashed.end()) {
          finish_unmeasured(group, cell, verify::Verdict::kError, found->second);
        }
      }
    }
    filter_cells(plan_, [&](const PlannedCell& cell) { return !crashed.contains(cell.id.key()); });
  }

  /// Measures groups together, so that the repetitions of a cell are as far apart in time as those
  /// of all: a disturbance of the machine for half a minute affects some repetitions of each view,
  /// not all of one.
  void run_batch(std::span<const CellGroup> groups, double share_ms) {
    const base::Stopwatch watch;
    std::vector<OpenGroup> open;
    double cells = 0.0;
    for (const CellGroup& group : groups) {
      cells += static_cast<double>(group.cells.size());
      if (std::optional<OpenGroup> opened = open_group(group)) open.push_back(std::move(*opened));
    }
    // The time of the oracle and of the counting passes belongs to the groups.
    measure(std::move(open), std::max(share_ms - watch.milliseconds() / cells, 0.0));
    set_activity("");
  }

  /// Makes the rays of a group and counts the work of its contenders. Where the scene has no rays,
  /// records that and returns nothing.
  std::optional<OpenGroup> open_group(const CellGroup& group) {
    progress_.start(shown(group));
    options_.before_each_piece();
    const auto fail = [&](verify::Verdict verdict, const std::string& why) {
      for (const PlannedCell& cell : group.cells) finish_unmeasured(group, cell, verdict, why);
      return std::nullopt;
    };
    OpenGroup open{&group, nullptr, {}};
    try {
      open.task = make_task(group, core_);
    } catch (const rays::NoRaysError& error) {  // the other groups are measured all the same
      return fail(verify::Verdict::kNoRays, error.what());
    } catch (const InputError& error) {
      return fail(verify::Verdict::kError, error.what());
    }
    if (const auto warning = open.task->warning()) {
      const std::string sentence = fmt::format("{}: {}.", shown(group), *warning);
      progress_.say("warning: " + sentence);
      log_.warn(sentence);
    }
    for (const PlannedCell& cell : group.cells) {
      set_activity(cell.id.key());
      options_.before_each_piece();
      open.contenders.emplace_back(cell, *open.task, config_.second_traces, earlier(cell))
          .count(log_);
      if (open.contenders.back().failed()) finish(open, std::prev(open.contenders.end()));
    }
    return open;
  }

  /// Runs rounds of one repetition for each contender until all are done. A round goes from group
  /// to group, and within one from contender to contender, in orders shuffled anew, so that a
  /// temporary slowdown of the machine affects all that are compared.
  void measure(std::vector<OpenGroup> groups, double allowance_ms) {
    if (groups.empty()) return;
    const Instruments instruments{benchmark_, counters_, core_, config_.threads};
    Random random(rays::fingerprint(groups.front().group->name()));
    finish_done(groups, allowance_ms);
    int round = 0;
    for (const OpenGroup& open : groups) {
      for (const Contender& each : open.contenders) round = std::max(round, each.next_round());
    }
    for (; !groups.empty(); ++round) {
      shuffle(groups, random);
      for (OpenGroup& open : groups) {
        shuffle(open.contenders, random);
        int position = 0;
        for (auto each = open.contenders.begin(); each != open.contenders.end(); ++position) {
          set_activity(each->id().key());
          options_.before_each_piece();
          each->repeat(instruments, round, position, log_);
          // Immediately: a run that is cut off now must not resume with a wrong repetition.
          each = each->failed() ? finish(open, each) : std::next(each);
          progress_.advance(work_done(groups, allowance_ms));
        }
      }
      finish_done(groups, allowance_ms);
    }
  }

  using Place = std::vector<Contender>::iterator;

  /// Records and removes a contender; returns the place of the next.
  Place finish(OpenGroup& open, Place contender, std::optional<StopReason> reason = std::nullopt) {
    finish(std::move(*contender).finish(reason));
    progress_.start(shown(*open.group));
    return open.contenders.erase(contender);
  }

  /// Records and removes the contenders that need no further repetition, and the groups that have
  /// none left.
  void finish_done(std::vector<OpenGroup>& groups, double allowance_ms) {
    const StoppingRule rule{config_.precision, config_.precise, config_.minimum_repetitions,
                            config_.maximum_repetitions};
    for (OpenGroup& open : groups) {
      for (Place each = open.contenders.begin(); each != open.contenders.end();) {
        const std::optional<StopReason> reason =
            reason_to_stop(each->totals(rule.precise), each->spent_ms(), allowance_ms, rule);
        each = reason ? finish(open, each, reason) : std::next(each);
      }
    }
    std::erase_if(groups, [](const OpenGroup& open) { return open.contenders.empty(); });
  }

  /// Returns the progress of the unfinished, in whole contenders: by the larger of the time and the
  /// repetitions that they have used up.
  double work_done(const std::vector<OpenGroup>& groups, double allowance_ms) const {
    double done = 0.0;
    for (const OpenGroup& open : groups) {
      for (const Contender& contender : open.contenders) {
        const double time = contender.spent_ms() / std::max(allowance_ms, 1.0);
        const auto repetitions = static_cast<double>(contender.repetitions());
        done += std::clamp(std::max(std::min(time, repetitions / config_.minimum_repetitions),
                                    repetitions / config_.maximum_repetitions),
                           0.0, 1.0);
      }
    }
    return done;
  }

  void set_activity(std::string_view cell) const {
    if (options_.activity) options_.activity->write(plugin::Activity::Line::kCell, cell);
  }

  void finish_unmeasured(const CellGroup& group, const PlannedCell& cell, verify::Verdict verdict,
                         const std::string& message) {
    CellRecord record{};
    record.index = cell.index;
    record.id = cell.id;
    record.rays.scene_hash = group.scene_hash;
    record.rays.primitives = group.scene->primitives.size();
    record.time_utc = utc_now();
    record.verdict = verdict;
    record.message = message;
    log_.begin_cell(record);
    finish(record);
  }

  void finish(const CellRecord& cell) {
    log_.finish_cell(cell);
    log_throttling();
    if (!cell.keeps_times()) {
      progress_.say(
          fmt::format("{}: {}: {}", to_string(cell.verdict), shown_name(cell.id), cell.message));
      for (const std::string& example : cell.examples) progress_.say(example);
    }
    progress_.start(shown_name(cell.id));
    progress_.finish(result_line(cell));
  }

  void log_throttling() {
    const std::optional<Throttling> total = throttling_.total();
    if (std::exchange(manifest_.measurement.throttling, total) != total && total) {
      log_.set_throttling(*total);
    }
  }

  const SweepConfig& config_;
  const GoogleBenchmark& benchmark_;
  const SweepOptions& options_;
  std::FILE* messages_;
  int core_;
  HardwareCounters counters_;
  Manifest manifest_;
  std::set<std::size_t> finished_;                ///< by an earlier part of the run: cells
  std::map<std::size_t, CellRecord> unfinished_;  ///< begun by it
  std::uint64_t log_bytes_ = 0;                   ///< that it wrote
  RunLog log_;
  ThrottlingWatch throttling_;
  std::vector<PlannedName> names_;  ///< of all cells
  Plan plan_;
  base::Progress progress_;
};

}  // namespace

std::filesystem::path run_sweep(const SweepConfig& config, Plan plan,
                                const GoogleBenchmark& benchmark, const SweepOptions& options,
                                std::FILE* messages) {
  return SweepRun(config, std::move(plan), benchmark, options, messages).run();
}

}  // namespace beambench::measure

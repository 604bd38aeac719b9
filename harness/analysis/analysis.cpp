#include "harness/analysis/analysis.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "harness/analysis/words.hpp"
#include "harness/base/messages.hpp"
#include "harness/measure/record/conditions.hpp"
#include "harness/measure/record/machine.hpp"
#include "harness/measure/record/shard.hpp"

namespace beambench::analysis {
namespace {

using measure::CellRecord;
using measure::Conditions;
using measure::QueryPath;
using Json = nlohmann::ordered_json;

std::optional<Overhead> overhead_of(const CellRecord& cell, const Names& names) {
  const std::optional<measure::Estimate> trace = trace_time(cell);
  if (cell.verdict != verify::Verdict::kOk || !trace || !cell.harness ||
      cell.harness->path == QueryPath::kImageOwn || cell.harness->path == QueryPath::kPicture) {
    return std::nullopt;
  }
  // Excludes a plug-in that takes less time than generating the rays one by one: it cannot generate
  // them that way, whatever it states.
  if (trace->value <= cell.harness->ms) return std::nullopt;
  const std::string title = fmt::format("{} in {} at {}", names.contender, names.view,
                                        rays::to_string(cell.id.resolution));
  return Overhead{std::string(to_string(cell.harness->path)), cell.id.name(), title,
                  cell.harness->ms / trace->value};
}

/// Returns the number of repetitions of a cell.
std::size_t repetitions_of(const CellRecord& cell) {
  const auto summed_up = cell.column("repetitions");
  return summed_up ? static_cast<std::size_t>(*summed_up) : cell.repetitions.size();
}

/// Returns whether a cell is as precise as the sweep required: by its prediction interval or, in a
/// record without blocks, by the reason why its repetitions ended.
bool is_precise(const CellRecord& cell, double precision) {
  if (!has_blocks(cell)) return cell.stop_reason == measure::StopReason::kPrecision;
  const auto trace = trace_time(cell);
  return trace && trace->prediction &&
         trace->prediction->high - trace->prediction->low <= 2.0 * precision * trace->value;
}

/// Returns whether a cell has too few blocks, or too few repetitions in one process, for an
/// interval.
bool is_without_interval(const CellRecord& cell) {
  constexpr std::size_t kMinRepetitions = 6;
  if (!has_blocks(cell)) return repetitions_of(cell) < kMinRepetitions;
  const auto trace = trace_time(cell);
  return !trace || !trace->confidence;
}

/// Widens the intervals of ratios by the part of the shift that chance does not explain.
void widen(std::vector<Standing>& standings, double excess) {
  const auto wider = [&](std::optional<Interval>& interval) {
    if (interval && interval->high != 1.0) {  // the fastest has no interval
      interval = Interval{interval->low * std::exp(-excess), interval->high * std::exp(excess)};
    }
  };
  for (Standing& one : standings) {
    wider(one.ratio.interval);
    wider(one.ratio.prediction);
  }
}

/// Returns a number, or null for infinity, which JSON lacks.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

const char* name_of(measure::TraceClock clock) {
  return clock == measure::TraceClock::kCpu ? "cpu" : "wall";
}

Json to_json(const TimeRatio& ratio) {
  Json json{{"value", ratio.value}};
  if (ratio.interval) {
    json["low"] = ratio.interval->low;
    json["high"] = ratio.interval->high;
  }
  if (ratio.prediction) {
    json["predicted_low"] = ratio.prediction->low;
    json["predicted_high"] = ratio.prediction->high;
  }
  json["paired"] = ratio.is_paired;
  return json;
}

Json to_json(const std::vector<Standing>& standings) {
  Json list = Json::array();
  for (const Standing& one : standings) {
    list.push_back({{"contender", one.contender},
                    {"structure", one.structure},
                    {"variant", one.variant},
                    {"isa", one.isa},
                    {"build_ms", one.build_ms},
                    {"ns_per_ray", one.ns_per_ray},
                    {"ratio", to_json(one.ratio)},
                    {"rank", to_string(one.rank())}});
  }
  return list;
}

Json to_json(const Standings& view) {
  Json left_out = Json::array();
  for (const LeftOut& one : view.left_out) {
    left_out.push_back({{"contender", one.contender}, {"reason", one.reason}});
  }
  Json json{{"view", view.view},
            {"subject", view.subject},
            {"size", view.size},
            {"ray_kind", view.ray_kind},
            {"rays", view.rays},
            {"clock", name_of(view.clock)},
            {"ranked", to_json(view.ranked)},
            {"references", to_json(view.references)},
            {"left_out", left_out},
            {"unrecorded", view.unrecorded},
            {"in_means", view.in_means}};
  if (const auto rays = view.break_even_rays()) {
    json["break_even"] = {{"rays", number(*rays)},
                          {"over", view.last_overtaken()->contender},
                          {"in_words", rays_in_words(*rays)}};
  }
  return json;
}

Json to_json(const FrameCost& cost) {
  return {{"ready_ms", cost.ready_ms},
          {"trace_ms", cost.trace_ms},
          {"sah_cost", cost.sah_cost ? Json(*cost.sah_cost) : Json()}};
}

Json to_json(const std::vector<FrameSeries>& all) {
  Json list = Json::array();
  for (const FrameSeries& series : all) {
    Json frames = Json::array();
    for (const FrameComparison& one : series.frames) {
      frames.push_back({{"frame", one.frame},
                        {"updated", to_json(one.updated)},
                        {"built", to_json(one.built)},
                        {"total_ratio", to_json(one.total)},
                        {"trace_ratio", to_json(one.trace)}});
    }
    const RebuildInterval interval = rebuild_interval(series);
    list.push_back({{"contender", series.contender},
                    {"subject", series.subject},
                    {"frames", frames},
                    {"rebuild_after", interval.is_all ? Json() : Json(interval.frames)},
                    {"mean_ms", interval.mean_ms}});
  }
  return list;
}

Json to_json(const std::vector<MeanStanding>& means) {
  Json list = Json::array();
  for (const MeanStanding& mean : means) {
    list.push_back({{"contender", mean.contender},
                    {"structure", mean.structure},
                    {"ratio", to_json(mean.ratio)},
                    {"views", mean.views},
                    {"wins", mean.wins}});
    if (!mean.scatter) continue;
    list.back()["scatter_low"] = mean.scatter->low;
    list.back()["scatter_high"] = mean.scatter->high;
  }
  return list;
}

}  // namespace

std::vector<Overhead> largest_overheads(const measure::Run& run) {
  const std::vector<Names> names = names_of(run);
  std::vector<Overhead> largest;
  for (std::size_t i = 0; i < run.cells.size(); ++i) {
    const std::optional<Overhead> found = overhead_of(run.cells[i], names[i]);
    if (!found) continue;
    const auto same = std::ranges::find(largest, found->path, &Overhead::path);
    if (same == largest.end()) {
      largest.push_back(*found);
    } else if (found->part > same->part) {
      *same = *found;
    }
  }
  std::ranges::stable_sort(largest, std::ranges::greater(), &Overhead::part);
  return largest;
}

std::vector<std::string> reasons_for_care(const measure::Run& run) {
  constexpr double kPrecisePart = 0.8;
  const double precision = run.config.value("precision", 0.02);
  bool is_of_one_process = false;
  std::size_t timed = 0, imprecise = 0, without_interval = 0;
  for (const CellRecord& cell : run.cells) {
    if (!trace_time(cell)) continue;
    ++timed;
    if (!is_precise(cell, precision)) ++imprecise;
    if (is_without_interval(cell)) ++without_interval;
    if (!has_blocks(cell)) is_of_one_process = true;
  }
  const Conditions conditions = measure::conditions_of(run.manifest);
  std::vector<std::string> reasons;
  if (const auto found = steadiness(run); found && !found->is_steady()) {
    reasons.push_back(
        fmt::format("the machine was not steady: late blocks took {:.1f}% {} than early ones; "
                    "chance explains {:.1f}%",
                    100 * std::abs(std::expm1(found->shift)),
                    found->shift > 0.0 ? "longer" : "less", 100 * std::expm1(found->limit)));
  }
  if (is_of_one_process) {
    reasons.emplace_back("measured by one process, so unranked: the order proves nothing");
  }
  if (conditions.noise && *conditions.noise > measure::kNoisy) {
    reasons.push_back(
        fmt::format("equal work took up to {:.0f}% longer than usual", 100 * *conditions.noise));
  }
  if (const auto other = measure::describe_other_work(conditions.other_work))
    reasons.push_back(*other);
  if (const auto throttled = measure::describe(conditions.throttling))
    reasons.push_back(*throttled);
  if (static_cast<double>(timed - imprecise) < kPrecisePart * static_cast<double>(timed)) {
    reasons.push_back(fmt::format("{} of {} less precise than requested", imprecise,
                                  base::counted(timed, "timed cell")));
  }
  if (without_interval > 0) {
    reasons.push_back(fmt::format("{} of {} repeated too few times for an interval",
                                  without_interval, base::counted(timed, "timed cell")));
  }
  if (!run.is_ended()) reasons.emplace_back("the run was cut off");
  return reasons;
}

Analysis analyze(const measure::Run& run) {
  Analysis analysis;
  analysis.cells = run.cells.size();
  analysis.planned = run.plan.size();
  analysis.is_part = measure::shard_of_manifest(run.manifest).has_value();
  for (const CellRecord& cell : run.cells) {
    if (cell.verdict == verify::Verdict::kNoRays) {
      ++analysis.without_rays;
    } else if (cell.verdict == verify::Verdict::kUnsupported) {
      ++analysis.unsupported;
    } else if (!cell.keeps_times()) {
      ++analysis.failed;
    }
  }
  analysis.reasons_for_care = reasons_for_care(run);
  analysis.views = standings(run);
  analysis.steadiness = steadiness(run);
  if (const double excess = analysis.steadiness ? analysis.steadiness->excess() : 0.0;
      excess > 0.0) {
    for (Standings& view : analysis.views) {
      widen(view.ranked, excess);
      widen(view.references, excess);
    }
  }
  analysis.means = overall(analysis.views);
  analysis.overheads = largest_overheads(run);
  analysis.block_totals = block_totals(run);
  analysis.frame_series = frame_series(run);
  return analysis;
}

int exit_code_of(const Analysis& analysis) {
  if (analysis.possible() == 0 && !analysis.is_part) return base::kInvalidInput;
  return analysis.failed > 0 ? base::kMismatch : base::kSuccess;
}

Json to_json(const Analysis& analysis) {
  Json views = Json::array(), means = Json::array(), overheads = Json::array();
  Json totals = Json::array();
  for (const Standings& view : analysis.views) views.push_back(to_json(view));
  for (const OverallStandings& one : analysis.means) {
    means.push_back({{"ray_kind", one.ray_kind},
                     {"views", one.views},
                     {"means", to_json(one.means)},
                     {"references", to_json(one.references)}});
  }
  for (const Overhead& one : analysis.overheads) {
    overheads.push_back(
        {{"query_path", one.path}, {"cell", one.cell}, {"title", one.title}, {"part", one.part}});
  }
  for (const BlockTotals& one : analysis.block_totals) {
    Json ms = Json::object();
    for (const auto& [block, time] : one.ms) ms[std::to_string(block)] = time;
    totals.push_back({{"cell", one.cell}, {"clock", name_of(one.clock)}, {"total_ms", ms}});
  }
  return {{"schema_version", 2},
          {"cells", analysis.cells},
          {"planned", analysis.planned},
          {"failed", analysis.failed},
          {"without_rays", analysis.without_rays},
          {"unsupported", analysis.unsupported},
          {"is_part", analysis.is_part},
          {"reasons_for_care", analysis.reasons_for_care},
          {"steadiness", analysis.steadiness ? Json{{"shift", analysis.steadiness->shift},
                                                    {"limit", analysis.steadiness->limit}}
                                             : Json()},
          {"views", views},
          {"means", means},
          {"harness_overheads", overheads},
          {"block_totals", totals},
          {"frame_series", to_json(analysis.frame_series)}};
}

}  // namespace beambench::analysis

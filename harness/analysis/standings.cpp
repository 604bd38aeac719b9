#include "harness/analysis/standings.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <ranges>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/analysis/results_csv.hpp"
#include "harness/measure/plan.hpp"
#include "harness/plugin/program_contender.hpp"

namespace beambench::analysis {
namespace {

using measure::CellRecord;
using measure::Estimate;
using measure::Repetition;
using measure::shown_scene;
using measure::TraceClock;
using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 2> kReferences{"null", "exhaustive"};

bool is_reference(const std::string& structure) {
  return std::ranges::find(kReferences, structure) != kReferences.end();
}

/// Returns the median of a figure of a cell without blocks: over its repetitions, or as recorded.
template <class Figure>
std::optional<Estimate> median_of(const CellRecord& cell, Figure figure,
                                  const std::string& column) {
  if (cell.has_times()) {
    const std::vector<double> samples = measure::collect(cell, figure);
    return Estimate{measure::median(samples), measure::median_interval(samples)};
  }
  const auto middle = cell.column(column + "_median");
  if (!middle || !cell.keeps_times()) return std::nullopt;
  const auto low = cell.column(column + "_ci_low"), high = cell.column(column + "_ci_high");
  return low && high ? Estimate{*middle, Interval{*low, *high}} : Estimate{*middle};
}

double build_ms_of(const CellRecord& cell) {
  if (has_blocks(cell)) return measure::minimum(measure::collect(cell, &Repetition::ready_ms));
  const auto build = median_of(cell, &Repetition::build_ms, "build_ms");
  return build ? build->value : 0.0;
}

/// Returns the mean over the blocks of a cell; nothing if its hits are not correct.
std::optional<Estimate> mean_of(const CellRecord& cell, const TimesByBlock& by_block) {
  if (!cell.keeps_times() || by_block.empty()) return std::nullopt;
  const auto values = by_block | std::views::values;
  return measure::estimate(std::vector<double>(values.begin(), values.end()));
}

TimesByRound trace_times(const CellRecord& cell) {
  TimesByRound times;
  for (const Repetition& one : cell.repetitions) times[one.round] = one.trace_ms;
  return times;
}

TimeRatio trace_ratio(const CellRecord& cell, const CellRecord& base, TraceClock clock) {
  if (cell.index == base.index) {
    return {1.0, Interval{1.0, 1.0}, true,
            has_blocks(cell) ? std::optional(Interval{1.0, 1.0}) : std::nullopt};
  }
  const auto paired = has_blocks(cell) && has_blocks(base)
                          ? block_ratio(trace_by_block(cell, clock), trace_by_block(base, clock))
                          : paired_ratio(trace_times(cell), trace_times(base));
  if (paired) return *paired;
  const Estimate over = *trace_time(cell, clock), under = *trace_time(base, clock);
  return unpaired_ratio({over.value, over.confidence}, {under.value, under.confidence});
}

/// Returns the condition of the sweep that excludes a contender from a view; nothing if none does.
std::optional<std::string> why_absent(const std::string& structure, const CellRecord& cell,
                                      const Json& exclude) {
  for (const Json& entry : exclude) {
    if (entry.value("structure", structure) != structure) continue;
    if (entry.contains("scene") &&
        shown_scene(entry.at("scene").get<std::string>()) != shown_scene(cell.id.scene)) {
      continue;
    }
    std::vector<std::string> limits;
    const auto is_above = [&](std::uint64_t count, const std::string& what) {
      const auto limit = entry.find(what + "_above");
      if (limit == entry.end()) return true;
      limits.push_back(fmt::format("more than {} {}", limit->get<std::uint64_t>(), what));
      return count > limit->get<std::uint64_t>();
    };
    const bool by_size = is_above(cell.rays.primitives, "primitives");
    if (!is_above(cell.rays.rays, "rays") || !by_size) continue;
    return fmt::format("left out by the sweep ({})",
                       limits.empty() ? "this scene" : fmt::to_string(fmt::join(limits, " and ")));
  }
  return std::nullopt;
}

/// The cells of a view, by contender.
using ViewCells = std::vector<std::pair<std::string, const CellRecord*>>;

/// Returns the highest number of rays that at least two contenders have; if there is only one
/// contender, its highest number.
std::uint64_t finest_rays(const ViewCells& all) {
  std::map<std::uint64_t, std::set<std::string>> contenders;
  for (const auto& [contender, cell] : all) {
    std::set<std::string>& own = contenders[cell->rays.rays];
    if (!is_reference(cell->id.structure)) own.insert(contender);
  }
  for (auto one = contenders.rbegin(); one != contenders.rend(); ++one) {
    if (one->second.size() > 1) return one->first;
  }
  return contenders.rbegin()->first;
}

/// Returns whether hardly any closest-hit ray hits, or almost all or hardly any any-hit rays are
/// occluded. Returns false for records without blocks, whose published means must not change.
bool is_degenerate(const CellRecord& cell) {
  constexpr double kFew = 0.01;
  if (!has_blocks(cell)) return false;
  const double hit = cell.rays.hit_share.value_or(1.0);
  const double occluded = cell.rays.occluded_share.value_or(0.5);
  return hit < kFew || occluded < kFew || occluded > 1.0 - kFew;
}

/// Returns the clock by which a view's contenders are compared: the CPU clock if other processes
/// disturbed one of them too often. (With several threads, disturbances are not detected.)
template <class Cells>
TraceClock clock_of(const Cells& cells) {
  const bool disturbed = std::ranges::any_of(cells, [](const CellRecord* cell) {
    return has_blocks(*cell) && measure::is_disturbed(*cell);
  });
  return disturbed ? TraceClock::kCpu : TraceClock::kWall;
}

Standings of_view(const Names& names, const ViewCells& all,
                  const std::vector<std::pair<std::string, std::string>>& structures,
                  const Json& exclude) {
  const std::uint64_t most = finest_rays(all);
  std::map<std::string, const CellRecord*> finest;
  for (const auto& [contender, cell] : all) {
    if (cell->rays.rays == most) finest[contender] = cell;
  }
  const CellRecord& first = *finest.begin()->second;
  const TraceClock clock = clock_of(finest | std::views::values);
  Standings result{names.view,
                   names.subject,
                   rays::to_string(first.id.resolution),
                   rays::divide_label(first.id.rays).rays,
                   most,
                   {},
                   {},
                   {}};
  result.clock = clock;
  result.is_degenerate = is_degenerate(first);
  std::vector<std::pair<double, std::string>> order;
  for (const auto& [contender, structure] : structures) {
    const auto cell = finest.find(contender);
    if (cell == finest.end()) {
      const auto reason = why_absent(structure, first, exclude);
      if (!reason) ++result.unrecorded;
      result.left_out.push_back({contender, reason.value_or("not in the record")});
    } else if (const auto trace = trace_time(*cell->second, clock); trace && trace->value > 0.0) {
      order.emplace_back(trace->value, contender);
    } else {
      const std::string& message = cell->second->message;
      result.left_out.push_back({contender, std::string(to_string(cell->second->verdict)) +
                                                (message.empty() ? "" : ": " + message)});
    }
  }
  std::ranges::sort(order);
  const auto base = std::ranges::find_if(order, [&](const auto& entry) {
    return !is_reference(finest.at(entry.second)->id.structure);
  });
  if (base == order.end()) return result;
  for (const auto& [trace_ms, contender] : order) {
    const CellRecord& cell = *finest.at(contender);
    Standing standing{
        contender,
        cell.id.structure,
        cell.parameter_sets > 1 ? measure::shown_structure(cell.id) : "",
        cell.statistics ? cell.statistics->instruction_set : "",
        cell.statistics && cell.statistics->library_version.ends_with(plugin::kSelfReportedNote),
        build_ms_of(cell),
        1e6 * trace_ms / static_cast<double>(most),
        trace_ratio(cell, *finest.at(base->second), clock)};
    auto& list = is_reference(standing.structure) ? result.references : result.ranked;
    list.push_back(std::move(standing));
  }
  return result;
}

double break_even(const Standing& mine, const Standing& other) {
  return break_even_rays({mine.build_ms, mine.ns_per_ray}, {other.build_ms, other.ns_per_ray});
}

std::vector<MeanStanding> means(const std::vector<const Standing*>& standings) {
  std::map<std::string, std::vector<const Standing*>> by_contender;
  for (const Standing* one : standings) by_contender[one->contender].push_back(one);
  std::vector<MeanStanding> found;
  for (const auto& [contender, own] : by_contender) {
    const auto wins = std::ranges::count_if(own, &Standing::is_tied);
    std::vector<TimeRatio> ratios;
    for (const Standing* one : own) ratios.push_back(one->ratio);
    found.push_back({contender, own.front()->structure, geometric_mean(ratios), scatter(ratios),
                     static_cast<int>(own.size()), static_cast<int>(wins)});
  }
  std::ranges::stable_sort(found, [](const MeanStanding& a, const MeanStanding& b) {
    return a.views != b.views ? a.views > b.views : a.ratio.value < b.ratio.value;
  });
  return found;
}

/// Selects the highest resolution if several machines measured a view, one at each resolution.
void mark_counted(std::vector<Standings>& views) {
  std::map<std::string, std::uint64_t> most;  // rays of each view, on any machine
  for (const Standings& view : views) {
    if (!view.ranked.empty()) most[view.subject] = std::max(most[view.subject], view.rays);
  }
  for (Standings& view : views) {
    view.in_means =
        !view.ranked.empty() && view.rays == most.at(view.subject) && !view.is_degenerate;
  }
}

}  // namespace

std::string_view to_string(Rank rank) {
  constexpr std::array<std::string_view, 4> kNames{"tied", "behind", "undecided", "unranked"};
  return kNames[static_cast<std::size_t>(rank)];
}

std::string Standing::name() const {
  return variant.empty() ? contender : variant + contender.substr(structure.size());
}

Rank Standing::rank() const {
  if (!ratio.interval) return Rank::kUnranked;
  if (!ratio.prediction) return ratio.interval->low <= 1.0 ? Rank::kTied : Rank::kBehind;
  if (ratio.interval->high <= 1.0 + kMargin) return Rank::kTied;
  return ratio.interval->low > 1.0 ? Rank::kBehind : Rank::kUndecided;
}

const Standing* Standings::behind() const {
  const auto found = std::ranges::find(ranked, Rank::kBehind, &Standing::rank);
  return found == ranked.end() ? nullptr : &*found;
}

const Standing* Standings::embree() const {
  const auto found = std::ranges::find(ranked, "embree", &Standing::structure);
  return found == ranked.end() ? nullptr : &*found;
}

const Standing* Standings::last_overtaken() const {
  const Standing* last = nullptr;
  for (const Standing& one : ranked) {
    if (one.rank() != Rank::kBehind) continue;
    if (last == nullptr || break_even(ranked.front(), one) > break_even(ranked.front(), *last)) {
      last = &one;
    }
  }
  return last;
}

std::optional<double> Standings::break_even_rays() const {
  const Standing* const last = last_overtaken();
  return last == nullptr ? std::nullopt : std::optional(break_even(ranked.front(), *last));
}

std::set<std::size_t> outpaced_sets(const measure::Run& run) {
  std::map<std::string, std::vector<std::pair<double, std::size_t>>> contenders;
  for (const CellRecord& cell : run.cells) {
    if (cell.parameter_sets == 1) continue;
    measure::CellId contender = cell.id;
    contender.parameters.clear();
    const auto trace = cell.has_times() ? trace_time(cell) : std::nullopt;
    contenders[contender.name()].emplace_back(
        trace ? trace->value : std::numeric_limits<double>::infinity(), cell.index);
  }
  std::set<std::size_t> outpaced;
  for (auto& [contender, sets] : contenders) {
    std::ranges::sort(sets);
    for (std::size_t i = 1; i < sets.size(); ++i) outpaced.insert(sets[i].second);
  }
  return outpaced;
}

std::vector<Names> names_of(const measure::Run& run) {
  const std::map<int, measure::RunFacts> facts = facts_by_shard(run.manifest);
  std::vector<NamedCell> cells;
  cells.reserve(run.cells.size());
  for (const auto& [scene, camera, structure, parameters, resolution, samples, rays] :
       run.cells | std::views::transform(&CellRecord::id)) {
    cells.push_back({scene, camera, structure, parameters, samples, rays,
                     facts.at(run.cells[cells.size()].shard).machine_id,
                     run.cells[cells.size()].parameter_sets});
  }
  return name_cells(cells);
}

bool has_blocks(const CellRecord& cell) {
  return !cell.repetitions.empty() && cell.repetitions.front().block >= 0;
}

std::optional<Estimate> trace_time(const CellRecord& cell, std::optional<TraceClock> clock) {
  if (!has_blocks(cell)) return median_of(cell, &Repetition::trace_ms, "trace_ms");
  return mean_of(cell, trace_by_block(cell, clock.value_or(own_clock(cell))));
}

std::optional<Estimate> total_time(const CellRecord& cell) {
  if (!has_blocks(cell)) return median_of(cell, &Repetition::total_ms, "total_ms");
  return mean_of(cell, total_by_block(cell, own_clock(cell)));
}

std::vector<BlockTotals> block_totals(const measure::Run& run) {
  const std::vector<Names> names = names_of(run);
  std::vector<std::string> view_of;  // the view of each cell, with the resolution
  std::map<std::string, std::vector<const CellRecord*>> views;
  for (std::size_t i = 0; i < run.cells.size(); ++i) {
    const CellRecord& cell = run.cells[i];
    view_of.push_back(names[i].view + ' ' + rays::to_string(cell.id.resolution));
    views[view_of.back()].push_back(&cell);
  }
  std::map<std::string, TraceClock> clocks;
  for (const auto& [view, cells] : views) clocks[view] = clock_of(cells);
  std::vector<BlockTotals> totals;
  for (std::size_t i = 0; i < run.cells.size(); ++i) {
    const CellRecord& cell = run.cells[i];
    if (!has_blocks(cell) || !cell.keeps_times()) continue;
    const TraceClock clock = clocks.at(view_of[i]);
    totals.push_back({cell.id.name(), clock, total_by_block(cell, clock)});
  }
  return totals;
}

std::vector<Standings> standings(const measure::Run& run) {
  const std::vector<Names> names = names_of(run);
  std::vector<std::pair<Names, ViewCells>> views;
  std::vector<std::pair<std::string, std::string>> structures;  // the structures of each contender
  const std::set<std::size_t> outpaced = outpaced_sets(run);
  for (std::size_t i = 0; i < run.cells.size(); ++i) {
    if (outpaced.contains(run.cells[i].index)) continue;
    auto view = std::ranges::find_if(
        views, [&](const auto& entry) { return entry.first.view == names[i].view; });
    if (view == views.end()) view = views.insert(views.end(), {names[i], {}});
    view->second.emplace_back(names[i].contender, &run.cells[i]);
    if (std::ranges::find(structures, names[i].contender,
                          &std::pair<std::string, std::string>::first) == structures.end()) {
      structures.emplace_back(names[i].contender, run.cells[i].id.structure);
    }
  }
  const Json exclude(run.config.value("exclude", nlohmann::json::array()));
  std::vector<Standings> result;
  for (const auto& [own, cells] : views) {
    result.push_back(of_view(own, cells, structures, exclude));
  }
  mark_counted(result);
  return result;
}

std::vector<OverallStandings> overall(std::span<const Standings> views) {
  std::vector<OverallStandings> result;
  for (const Standings& view : views) {
    if (!view.in_means ||
        std::ranges::find(result, view.ray_kind, &OverallStandings::ray_kind) != result.end()) {
      continue;
    }
    std::vector<const Standing*> ranked, references;
    int count = 0;
    for (const Standings& one : views) {
      if (one.ray_kind != view.ray_kind || !one.in_means) continue;
      ++count;
      for (const Standing& standing : one.ranked) ranked.push_back(&standing);
      for (const Standing& standing : one.references) references.push_back(&standing);
    }
    result.push_back({view.ray_kind, count, means(ranked), means(references)});
  }
  return result;
}

}  // namespace beambench::analysis

#include "harness/analysis/standings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/analysis/results_csv.hpp"
#include "harness/measure/plan.hpp"
#include "scenes/base/parameters.hpp"

namespace beambench::analysis {
namespace {

using measure::CellRecord;
using measure::collect;
using measure::median;
using measure::median_interval;
using measure::Repetition;
using measure::shown_scene;
using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 2> kReferences{"null", "exhaustive"};

bool is_reference(const std::string& structure) {
  return std::ranges::find(kReferences, structure) != kReferences.end();
}

double median_of(const CellRecord& cell, double Repetition::*figure) {
  return median(collect(cell, figure));
}

/// Cells without correct hits are not timed.
bool is_timed(const CellRecord& cell) {
  return cell.has_times() && median_of(cell, &Repetition::trace_ms) > 0.0;
}

/// Returns the parameters in the order of the record.
std::vector<std::pair<std::string, std::string>> parameters_of(const CellRecord& cell) {
  const auto& [structure, parameters] = std::tie(cell.id.structure, cell.id.parameters);
  return parse_spec(parameters.empty() ? structure : structure + ":" + parameters).parameters;
}

/// Names the cells of a run by what differs between them.
class Names {
 public:
  explicit Names(const measure::Run& run) : facts_(facts_by_shard(run.manifest)) {
    for (const CellRecord& cell : run.cells) {
      cameras_[cell.id.scene].insert(cell.id.camera);
      samples_.insert(cell.id.samples);
      used_machines_.insert(machine(cell));
      kinds_.insert(cell.id.rays);
      for (const auto& [name, value] : parameters_of(cell)) {
        values_[cell.id.structure][name].insert(value);
      }
    }
  }

  std::string contender(const CellRecord& cell) const {
    std::string label = cell.id.structure;
    for (const auto& [name, value] : parameters_of(cell)) {
      if (values_.at(cell.id.structure).at(name).size() > 1) {
        label += fmt::format(" {}={}", name, value);
      }
    }
    return label;
  }

  std::string view(const CellRecord& cell) const {
    constexpr std::size_t kShownDigits = 8;
    const std::string shown = machine(cell).substr(0, kShownDigits);
    return subject(cell) + (used_machines_.size() > 1 ? ", machine " + shown : "");
  }

  /// A view, whichever machine measured it.
  std::string subject(const CellRecord& cell) const {
    std::string title = shown_scene(cell.id.scene);
    const auto has_several = [](const auto& entry) { return entry.second.size() > 1; };
    if (std::ranges::any_of(cameras_, has_several)) title += ", camera " + cell.id.camera;
    if (samples_.size() > 1) title += fmt::format(", {} samples", cell.id.samples);
    if (kinds_.size() > 1) title += ", " + cell.id.rays + " rays";
    return title;
  }

 private:
  const std::string& machine(const CellRecord& cell) const {
    return facts_.at(cell.shard).machine_id;
  }

  std::map<std::string, std::set<std::string>> cameras_;
  std::set<int> samples_;
  std::set<std::string> kinds_;
  std::map<int, measure::RunFacts> facts_;  ///< of each shard
  std::set<std::string> used_machines_;
  std::map<std::string, std::map<std::string, std::set<std::string>>> values_;
};

/// The ratio of two medians; with an interval where both have one (Zou and Donner, Statistics in
/// Medicine 27, 2008).
TimeRatio unpaired_trace_ratio(const CellRecord& over, const CellRecord& under) {
  const std::vector<double> a = collect(over, &Repetition::trace_ms);
  const std::vector<double> b = collect(under, &Repetition::trace_ms);
  const double upper = median(a);
  const double lower = median(b);
  TimeRatio ratio{upper / lower};
  const auto of_a = median_interval(a);
  const auto of_b = median_interval(b);
  if (of_a && of_b && of_a->low > 0.0 && of_b->low > 0.0) {
    const double down = std::hypot(std::log(upper / of_a->low), std::log(of_b->high / lower));
    const double up = std::hypot(std::log(of_a->high / upper), std::log(lower / of_b->low));
    ratio.interval = Interval{ratio.value * std::exp(-down), ratio.value * std::exp(up)};
  }
  return ratio;
}

TimeRatio trace_ratio(const CellRecord& cell, const CellRecord& base) {
  if (cell.index == base.index) return {1.0, Interval{1.0, 1.0}, true};
  const auto paired = paired_trace_ratio(cell, base);
  return paired ? *paired : unpaired_trace_ratio(cell, base);
}

/// The condition of the sweep that leaves a contender out of a view.
std::string why_absent(const std::string& structure, const CellRecord& cell, const Json& exclude) {
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
  return "not in the record";
}

/// The cells of a view, by contender.
using ViewCells = std::vector<std::pair<std::string, const CellRecord*>>;

/// The highest number of rays that two contenders have; of fewer contenders, the highest.
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

Standings of_view(const std::string& view, const Names& names, const ViewCells& all,
                  const std::vector<std::pair<std::string, std::string>>& structures,
                  const Json& exclude) {
  const std::uint64_t most = finest_rays(all);
  std::map<std::string, const CellRecord*> finest;
  for (const auto& [contender, cell] : all) {
    if (cell->rays.rays == most) finest[contender] = cell;
  }
  const CellRecord& first = *finest.begin()->second;
  Standings result{
      view, names.subject(first), rays::to_string(first.id.resolution), first.id.rays, most, {}, {},
      {}};
  std::vector<std::pair<double, std::string>> order;
  for (const auto& [contender, structure] : structures) {
    const auto cell = finest.find(contender);
    if (cell == finest.end()) {
      result.left_out.push_back({contender, why_absent(structure, first, exclude)});
    } else if (is_timed(*cell->second)) {
      order.emplace_back(median_of(*cell->second, &Repetition::trace_ms), contender);
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
    Standing standing{contender, cell.id.structure, median_of(cell, &Repetition::build_ms),
                      1e6 * trace_ms / static_cast<double>(most),
                      trace_ratio(cell, *finest.at(base->second))};
    auto& list = is_reference(standing.structure) ? result.references : result.ranked;
    list.push_back(std::move(standing));
  }
  return result;
}

double break_even(const Standing& mine, const Standing& other) {
  const double dearer_ns = 1e6 * (mine.build_ms - other.build_ms);
  const double saved_ns = other.ns_per_ray - mine.ns_per_ray;
  if (dearer_ns <= 0.0) return 0.0;
  return saved_ns > 0.0 ? dearer_ns / saved_ns : std::numeric_limits<double>::infinity();
}

TimeRatio geometric_mean(const std::vector<const Standing*>& standings) {
  double sum = 0.0, down = 0.0, up = 0.0;
  bool known = true;
  bool all_paired = true;
  for (const Standing* one : standings) {
    all_paired = all_paired && one->ratio.is_paired;
    const double value = std::log(one->ratio.value);
    sum += value;
    known = known && one->ratio.interval && one->ratio.interval->low > 0.0;
    if (!known) continue;
    down = std::hypot(down, value - std::log(one->ratio.interval->low));
    up = std::hypot(up, std::log(one->ratio.interval->high) - value);
  }
  const auto count = static_cast<double>(standings.size());
  const double mean = sum / count;
  TimeRatio ratio{std::exp(mean), std::nullopt, all_paired};
  if (known) ratio.interval = Interval{std::exp(mean - down / count), std::exp(mean + up / count)};
  return ratio;
}

std::vector<MeanStanding> means(const std::vector<const Standing*>& standings) {
  std::map<std::string, std::vector<const Standing*>> by_contender;
  for (const Standing* one : standings) by_contender[one->contender].push_back(one);
  std::vector<MeanStanding> found;
  for (const auto& [contender, own] : by_contender) {
    const auto wins = std::ranges::count_if(own, &Standing::is_tied);
    found.push_back({contender, own.front()->structure, geometric_mean(own),
                     static_cast<int>(own.size()), static_cast<int>(wins)});
  }
  std::ranges::stable_sort(found, [](const MeanStanding& a, const MeanStanding& b) {
    return a.views != b.views ? a.views > b.views : a.ratio.value < b.ratio.value;
  });
  return found;
}

}  // namespace

const Standing* Standings::behind() const {
  const auto found = std::ranges::find_if_not(ranked, &Standing::is_tied);
  return found == ranked.end() ? nullptr : &*found;
}

const Standing* Standings::embree() const {
  const auto found = std::ranges::find(ranked, "embree", &Standing::structure);
  return found == ranked.end() ? nullptr : &*found;
}

const Standing* Standings::last_overtaken() const {
  const Standing* last = nullptr;
  for (const Standing& one : ranked) {
    if (one.is_tied()) continue;
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

std::optional<TimeRatio> paired_trace_ratio(const CellRecord& over, const CellRecord& under) {
  std::map<int, double> divisors;
  for (const Repetition& one : under.repetitions) divisors[one.round] = one.trace_ms;
  std::vector<double> ratios;
  for (const Repetition& one : over.repetitions) {
    const auto divisor = divisors.find(one.round);
    if (divisor == divisors.end() || divisor->second <= 0.0) continue;
    ratios.push_back(one.trace_ms / divisor->second);
  }
  if (ratios.empty()) return std::nullopt;
  return TimeRatio{median(ratios), median_interval(ratios), true};
}

std::vector<Standings> standings(const measure::Run& run) {
  const Names names(run);
  std::vector<std::pair<std::string, ViewCells>> views;
  std::vector<std::pair<std::string, std::string>> structures;  // of each contender
  for (const CellRecord& cell : run.cells) {
    const std::string title = names.view(cell);
    const std::string contender = names.contender(cell);
    auto view = std::ranges::find(views, title, &std::pair<std::string, ViewCells>::first);
    if (view == views.end()) view = views.insert(views.end(), {title, {}});
    view->second.emplace_back(contender, &cell);
    if (std::ranges::find(structures, contender, &std::pair<std::string, std::string>::first) ==
        structures.end()) {
      structures.emplace_back(contender, cell.id.structure);
    }
  }
  const Json exclude(run.config.value("exclude", nlohmann::json::array()));
  std::vector<Standings> result;
  for (const auto& [title, own] : views) {
    result.push_back(of_view(title, names, own, structures, exclude));
  }
  return result;
}

std::vector<OverallStandings> overall(std::span<const Standings> views) {
  std::map<std::string, std::uint64_t> most;  // rays of each view, whichever machine traced them
  for (const Standings& view : views) {
    if (!view.ranked.empty()) most[view.subject] = std::max(most[view.subject], view.rays);
  }
  const auto counts = [&](const Standings& view) {
    return !view.ranked.empty() && view.rays == most.at(view.subject);
  };
  std::vector<OverallStandings> result;
  for (const Standings& view : views) {
    if (!counts(view) ||
        std::ranges::find(result, view.ray_kind, &OverallStandings::ray_kind) != result.end()) {
      continue;
    }
    std::vector<const Standing*> ranked, references;
    int count = 0;
    for (const Standings& one : views) {
      if (one.ray_kind != view.ray_kind || !counts(one)) continue;
      ++count;
      for (const Standing& standing : one.ranked) ranked.push_back(&standing);
      for (const Standing& standing : one.references) references.push_back(&standing);
    }
    result.push_back({view.ray_kind, count, means(ranked), means(references)});
  }
  return result;
}

}  // namespace beambench::analysis

#include "harness/bench/standings.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/base/messages.hpp"
#include "harness/bench/plan.hpp"
#include "scenes/core/parameters.hpp"

namespace beambench::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<std::string_view, 2> kReferences{"null", "exhaustive"};

bool is_reference(const std::string& structure) {
  return std::ranges::find(kReferences, structure) != kReferences.end();
}

std::string text(const Json& row, const char* column) { return row.at(column).get<std::string>(); }

std::string machine_of(const Json& row) { return row.value("machine_id", ""); }

std::optional<double> figure(const Json& row, const std::string& column) {
  const auto found = row.find(column);
  return found == row.end() || found->is_null() ? std::nullopt
                                                : std::optional(found->get<double>());
}

/// Cells without correct hits are not timed.
bool is_timed(const Json& row) { return figure(row, "trace_ms_median").value_or(0.0) > 0.0; }

/// In the order of the record.
std::vector<std::pair<std::string, std::string>> parameters_of(const Json& row) {
  const std::string parameters = text(row, "parameters");
  const std::string structure = text(row, "structure");
  return parse_spec(parameters.empty() ? structure : structure + ":" + parameters).parameters;
}

/// What the cells of a run are called: by what differs between them.
class Names {
 public:
  explicit Names(std::span<const Json> cells) {
    for (const Json& cell : cells) {
      const Json& row = cell.at("row");
      cameras_[text(row, "scene")].insert(text(row, "camera"));
      samples_.insert(row.at("samples").get<int>());
      machines_.insert(machine_of(row));
      kinds_.insert(text(row, "ray_kind"));
      for (const auto& [name, value] : parameters_of(row)) {
        values_[text(row, "structure")][name].insert(value);
      }
    }
  }

  std::string contender(const Json& row) const {
    const std::string structure = text(row, "structure");
    std::string label = structure;
    for (const auto& [name, value] : parameters_of(row)) {
      if (values_.at(structure).at(name).size() > 1) label += fmt::format(" {}={}", name, value);
    }
    return label;
  }

  std::string view(const Json& row) const {
    constexpr std::size_t kShownDigits = 8;
    const std::string machine = machine_of(row).substr(0, kShownDigits);
    return subject(row) + (machines_.size() > 1 ? ", machine " + machine : "");
  }

  /// A view, whichever machine measured it.
  std::string subject(const Json& row) const {
    std::string title = shown_scene(text(row, "scene"));
    const auto has_several = [](const auto& entry) { return entry.second.size() > 1; };
    if (std::ranges::any_of(cameras_, has_several)) title += ", camera " + text(row, "camera");
    if (samples_.size() > 1) title += fmt::format(", {} samples", row.at("samples").get<int>());
    if (kinds_.size() > 1) title += ", " + text(row, "ray_kind") + " rays";
    return title;
  }

 private:
  std::map<std::string, std::set<std::string>> cameras_;
  std::set<int> samples_;
  std::set<std::string> kinds_;
  std::set<std::string> machines_;
  std::map<std::string, std::map<std::string, std::set<std::string>>> values_;
};

/// The ratio of two medians; with an interval where both have one (Zou and Donner, Statistics in
/// Medicine 27, 2008).
TimeRatio unpaired_trace_ratio(const Json& over, const Json& under) {
  const double a = *figure(over, "trace_ms_median");
  const double b = *figure(under, "trace_ms_median");
  TimeRatio ratio{a / b};
  const auto a_low = figure(over, "trace_ms_ci_low"), a_high = figure(over, "trace_ms_ci_high");
  const auto b_low = figure(under, "trace_ms_ci_low"), b_high = figure(under, "trace_ms_ci_high");
  if (a_low && a_high && b_low && b_high && *a_low > 0.0 && *b_low > 0.0) {
    const double down = std::hypot(std::log(a / *a_low), std::log(*b_high / b));
    const double up = std::hypot(std::log(*a_high / a), std::log(b / *b_low));
    ratio.interval = Interval{ratio.value * std::exp(-down), ratio.value * std::exp(up)};
  }
  return ratio;
}

TimeRatio trace_ratio(const Json& cell, const Json& base) {
  if (cell.at("key") == base.at("key")) return {1.0, Interval{1.0, 1.0}};
  const auto paired = paired_trace_ratio(cell.at("repetitions"), base.at("repetitions"));
  return paired ? *paired : unpaired_trace_ratio(cell.at("row"), base.at("row"));
}

/// The condition of the sweep that leaves a contender out of a view.
std::string why_absent(const std::string& structure, const Json& row,
                       std::span<const Exclusion> exclude) {
  for (const Exclusion& entry : exclude) {
    if (entry.structure.value_or(structure) != structure) continue;
    if (entry.scene && shown_scene(*entry.scene) != shown_scene(text(row, "scene"))) continue;
    std::vector<std::string> limits;
    const auto is_above = [&](const char* what, const std::optional<std::uint64_t>& limit) {
      if (limit) limits.push_back(fmt::format(fmt::runtime("more than {} {}"), *limit, what));
      return !limit || row.at(what).get<std::uint64_t>() > *limit;
    };
    const bool by_size = is_above("primitives", entry.primitives_above);
    if (!is_above("rays", entry.rays_above) || !by_size) continue;
    return fmt::format("left out by the sweep ({})",
                       limits.empty() ? "this scene" : fmt::to_string(fmt::join(limits, " and ")));
  }
  return "not in the record";
}

/// The cells of a view, by contender.
using ViewCells = std::vector<std::pair<std::string, const Json*>>;

Standings of_view(const std::string& view, const Names& names, const ViewCells& all,
                  const std::map<std::string, std::string>& structures,
                  std::span<const Exclusion> exclude) {
  const auto rays = [](const auto& entry) {
    return entry.second->at("row").at("rays").template get<std::uint64_t>();
  };
  const std::uint64_t most = rays(*std::ranges::max_element(all, {}, rays));
  std::map<std::string, const Json*> finest;
  for (const auto& entry : all) {
    if (rays(entry) == most) finest[entry.first] = entry.second;
  }
  const Json& first = finest.begin()->second->at("row");
  Standings result{
      view,
      names.subject(first),
      fmt::format("{}x{}", first.at("width").get<int>(), first.at("height").get<int>()),
      text(first, "ray_kind"),
      most,
      {},
      {},
      {}};
  std::vector<std::pair<double, std::string>> order;
  for (const auto& [contender, structure] : structures) {
    const auto cell = finest.find(contender);
    if (cell == finest.end()) {
      result.left_out.push_back({contender, why_absent(structure, first, exclude)});
    } else if (const Json& row = cell->second->at("row"); is_timed(row)) {
      order.emplace_back(row.at("trace_ms_median").get<double>(), contender);
    } else {
      const std::string message = text(*cell->second, "message");
      result.left_out.push_back(
          {contender, text(row, "verdict") + (message.empty() ? "" : ": " + message)});
    }
  }
  std::ranges::sort(order);
  const auto base = std::ranges::find_if(
      order, [&](const auto& entry) { return !is_reference(structures.at(entry.second)); });
  if (base == order.end()) return result;
  for (const auto& [trace_ms, contender] : order) {
    const Json& cell = *finest.at(contender);
    Standing standing{contender, structures.at(contender),
                      figure(cell.at("row"), "build_ms_median").value_or(0.0),
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
  for (const Standing* one : standings) {
    const double value = std::log(one->ratio.value);
    sum += value;
    known = known && one->ratio.interval && one->ratio.interval->low > 0.0;
    if (!known) continue;
    down = std::hypot(down, value - std::log(one->ratio.interval->low));
    up = std::hypot(up, std::log(one->ratio.interval->high) - value);
  }
  const auto count = static_cast<double>(standings.size());
  const double mean = sum / count;
  TimeRatio ratio{std::exp(mean)};
  if (known) ratio.interval = Interval{std::exp(mean - down / count), std::exp(mean + up / count)};
  return ratio;
}

std::vector<MeanStanding> means(const std::vector<const Standing*>& standings) {
  std::map<std::string, std::vector<const Standing*>> by_contender;
  for (const Standing* one : standings) by_contender[one->contender].push_back(one);
  std::vector<MeanStanding> found;
  for (const auto& [contender, own] : by_contender) {
    const auto wins = std::ranges::count_if(own, &Standing::is_tied);
    found.push_back(
        {contender, geometric_mean(own), static_cast<int>(own.size()), static_cast<int>(wins)});
  }
  std::ranges::stable_sort(found, [](const MeanStanding& a, const MeanStanding& b) {
    return a.views != b.views ? a.views > b.views : a.ratio.value < b.ratio.value;
  });
  return found;
}

std::string in_words(const TimeRatio& ratio) {
  if (!ratio.interval || ratio.interval->low == ratio.interval->high) {
    return fmt::format("{:.3g}", ratio.value);
  }
  return fmt::format("{:.3g} [{:.3g}, {:.3g}]", ratio.value, ratio.interval->low,
                     ratio.interval->high);
}

std::string rays_in_words(const std::optional<double>& rays) {
  if (!rays) return "";
  if (*rays <= 0.0) return "the first ray";
  if (!std::isfinite(*rays)) return "never";
  constexpr std::array<std::pair<double, const char*>, 4> kUnits{
      {{1e3, ""}, {1e6, " k"}, {1e9, " M"}, {1e12, " G"}}};
  for (const auto& [limit, unit] : kUnits) {
    if (*rays < limit) return fmt::format("{:.3g}{} rays", *rays * 1e3 / limit, unit);
  }
  return fmt::format("{:.3g} rays", *rays);
}

std::string table(const std::vector<std::vector<std::string>>& lines) {
  std::string out;
  for (const std::string& line : base::aligned(lines, lines.front().size())) {
    out += "  " + line + "\n";
  }
  return out;
}

/// The fastest, and those that may be as fast.
std::string winners(const Standings& view) {
  std::vector<std::string> names;
  for (const Standing& one : view.ranked) {
    if (one.is_tied()) names.push_back(one.contender);
  }
  return fmt::format("{}{}", names.size() > 1 ? "tie: " : "", fmt::join(names, ", "));
}

std::string against(const Standing* other, bool with_name) {
  if (other == nullptr) return "-";
  return (with_name ? other->contender + " " : "") + in_words(other->ratio);
}

/// `exhaustive: left out by the sweep (more than 1000 primitives), in 3 views`.
std::string describe_left_out(std::span<const Standings> views) {
  std::map<std::pair<std::string, std::string>, std::size_t> counts;
  for (const Standings& view : views) {
    for (const LeftOut& one : view.left_out) ++counts[{one.contender, one.reason}];
  }
  std::string out;
  for (const auto& [one, count] : counts) {
    out += fmt::format("  no time for {} in {}: {}\n", one.first, base::counted(count, "view"),
                       one.second);
  }
  return out;
}

std::string describe_mean(const OverallStandings& overall) {
  std::vector<std::vector<std::string>> lines{
      {"contender", "times the fastest of each view", "fastest or tied", "views"}};
  const auto add = [&](const MeanStanding& mean, const char* note, const std::string& wins) {
    lines.push_back({mean.contender + note, in_words(mean.ratio), wins,
                     fmt::format("{} of {}", mean.views, overall.views)});
  };
  for (const MeanStanding& mean : overall.means) {
    add(mean, "", fmt::format("{} of {}", mean.wins, overall.views));
  }
  for (const MeanStanding& mean : overall.references) add(mean, " (reference)", "-");
  return fmt::format("Over {} of {} rays, geometric means:\n{}",
                     base::counted(static_cast<std::size_t>(overall.views), "view"),
                     overall.ray_kind, table(lines));
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

std::optional<double> Standings::break_even_rays() const {
  std::optional<double> most;
  for (const Standing& one : ranked) {
    if (one.is_tied()) continue;
    most = std::max(most.value_or(0.0), break_even(ranked.front(), one));
  }
  return most;
}

std::optional<TimeRatio> paired_trace_ratio(const Json& over, const Json& under) {
  std::map<int, double> divisors;
  for (const Json& one : under) {
    divisors[one.at("round").get<int>()] = one.at("trace_ms").get<double>();
  }
  std::vector<double> ratios;
  for (const Json& one : over) {
    const auto divisor = divisors.find(one.at("round").get<int>());
    if (divisor == divisors.end() || divisor->second <= 0.0) continue;
    ratios.push_back(one.at("trace_ms").get<double>() / divisor->second);
  }
  if (ratios.empty()) return std::nullopt;
  return TimeRatio{median(ratios), median_interval(ratios)};
}

std::vector<Standings> standings(std::span<const Json> cells, std::span<const Exclusion> exclude) {
  const Names names(cells);
  std::vector<std::pair<std::string, ViewCells>> views;
  std::map<std::string, std::string> structures;  // of each contender
  for (const Json& cell : cells) {
    const Json& row = cell.at("row");
    const std::string title = names.view(row);
    auto view = std::ranges::find(views, title, &std::pair<std::string, ViewCells>::first);
    if (view == views.end()) view = views.insert(views.end(), {title, {}});
    view->second.emplace_back(names.contender(row), &cell);
    structures.emplace(names.contender(row), text(row, "structure"));
  }
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

std::string describe(std::span<const Standings> views) {
  std::vector<std::vector<std::string>> lines{
      {"view", "fastest", "the next", "Embree's best", "pays off from"}};
  for (const Standings& view : views) {
    const std::string title = fmt::format("{} {}", view.view, view.size);
    if (view.ranked.empty()) {
      lines.push_back({title, "no contender has a time", "", "", ""});
      continue;
    }
    lines.push_back({title, winners(view), against(view.behind(), true),
                     against(view.embree(), false), rays_in_words(view.break_even_rays())});
  }
  std::string out =
      "Fastest by trace time, build apart. Figures: how many times as long the others take, with "
      "95% intervals.\n" +
      table(lines) + describe_left_out(views);
  if (views.size() > 1) {
    for (const OverallStandings& one : overall(views)) {
      if (one.views == 1) continue;
      out += '\n';
      out += describe_mean(one);
    }
  }
  return out;
}

std::string describe_contenders(std::span<const Standings> views) {
  std::string out;
  for (const Standings& view : views) {
    std::vector<std::vector<std::string>> lines{
        {"contender", "build ms", "ns per ray", "Mrays/s", "times the fastest"}};
    const auto add = [&](const Standing& one, const char* note) {
      lines.push_back({one.contender + note, fmt::format("{:.4g}", one.build_ms),
                       fmt::format("{:.4g}", one.ns_per_ray),
                       fmt::format("{:.4g}", 1e3 / one.ns_per_ray), in_words(one.ratio)});
    };
    for (const Standing& one : view.ranked)
      add(one, &one != view.ranked.data() && one.is_tied() ? " (tied)" : "");
    for (const Standing& one : view.references) add(one, " (reference)");
    for (const LeftOut& one : view.left_out) lines.push_back({one.contender, one.reason});
    out += fmt::format("{} {}, {} {} rays\n{}\n", view.view, view.size, view.rays, view.ray_kind,
                       table(lines));
  }
  return out;
}

}  // namespace beambench::bench

#include "harness/analysis/words.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/base/messages.hpp"

namespace beambench::analysis {
namespace {

using measure::QueryPath;

std::string in_words(const TimeRatio& ratio) {
  if (!ratio.interval || ratio.interval->low == ratio.interval->high) {
    return fmt::format("{:.3g}", ratio.value);
  }
  return fmt::format("{:.3g} [{:.3g}, {:.3g}]", ratio.value, ratio.interval->low,
                     ratio.interval->high);
}

std::string table(const std::vector<std::vector<std::string>>& lines) {
  std::string out;
  for (const std::string& line : base::aligned(lines, lines.front().size())) {
    out += "  " + line + "\n";
  }
  return out;
}

/// Returns the longest time per ray of any contender or reference of a view.
double longest_time(const Standings& view) {
  double longest = 0.0;
  for (const auto* list : {&view.ranked, &view.references}) {
    for (const Standing& one : *list) longest = std::max(longest, one.ns_per_ray);
  }
  return longest;
}

/// Returns a bar whose length is a fraction of the longest time.
std::string bar(double part) {
  constexpr double kWidth = 30.0;
  return std::string(static_cast<std::size_t>(std::max(1L, std::lround(part * kWidth))), '#');
}

/// Returns the fastest contender, those tied with it, and the undecided ones.
std::string winners(const Standings& view) {
  std::vector<std::string> tied, others;
  for (const Standing& one : view.ranked) {
    if (&one == view.ranked.data() || one.is_tied()) {
      tied.push_back(one.name());
    } else if (one.rank() != Rank::kBehind) {
      others.push_back(one.name());
    }
  }
  return fmt::format("{}{}{}{}", tied.size() > 1 ? "tie: " : "", fmt::join(tied, ", "),
                     others.empty() ? "" : "; undecided: ", fmt::join(others, ", "));
}

std::string against(const Standing* other, bool with_name) {
  if (other == nullptr) return "-";
  return (with_name ? other->name() + " " : "") + in_words(other->ratio);
}

/// Returns `exhaustive: left out by the sweep (more than 1000 primitives), in 3 views`.
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

std::string_view subject_of(const std::string& path) {
  if (path == to_string(QueryPath::kImageSingle)) return "images by single rays";
  if (path == to_string(QueryPath::kImageSimd)) return "images by SIMD rays";
  if (path == to_string(QueryPath::kListPacked)) return "lists of rays packed by SIMD";
  return "lists of rays";
}

}  // namespace

std::string rays_in_words(double rays) {
  if (rays <= 0.0) return "the first ray";
  if (!std::isfinite(rays)) return "never";
  constexpr std::array<std::pair<double, const char*>, 4> kUnits{
      {{1e3, ""}, {1e6, " k"}, {1e9, " M"}, {1e12, " G"}}};
  for (const auto& [limit, unit] : kUnits) {
    if (rays < limit) return fmt::format("{:.3g}{} rays", rays * 1e3 / limit, unit);
  }
  return fmt::format("{:.3g} rays", rays);
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
    const std::optional<double> pays_off = view.break_even_rays();
    lines.push_back({title, winners(view), against(view.behind(), true),
                     against(view.embree(), false), pays_off ? rays_in_words(*pays_off) : ""});
  }
  std::string out =
      "Fastest by trace time, excluding the build. Figures: time relative to the fastest, with 95% "
      "confidence intervals.\n" +
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
    std::vector<std::vector<std::string>> lines{{"contender", "SIMD", "build ms", "ns per ray",
                                                 "Mrays/s", "times the fastest", "time per ray"}};
    const double longest = longest_time(view);
    const auto add = [&](const Standing& one, const std::string& note) {
      lines.push_back({one.name() + note, one.isa.empty() ? "-" : one.isa,
                       fmt::format("{:.4g}", one.build_ms), fmt::format("{:.4g}", one.ns_per_ray),
                       fmt::format("{:.4g}", 1e3 / one.ns_per_ray), in_words(one.ratio),
                       bar(one.ns_per_ray / longest)});
    };
    bool any_self_reported = false;
    const auto add_noted = [&](const Standing& one, std::string_view note) {
      std::vector<std::string_view> notes;
      if (!note.empty()) notes.push_back(note);
      if (one.self_reported) notes.push_back("self-reported");
      add(one, notes.empty() ? "" : fmt::format(" ({})", fmt::join(notes, ", ")));
      any_self_reported |= one.self_reported;
    };
    for (const Standing& one : view.ranked) {
      const bool is_first = &one == view.ranked.data();
      const bool is_plain = is_first || one.rank() == Rank::kBehind;
      add_noted(one, is_plain ? "" : to_string(one.rank()));
    }
    for (const Standing& one : view.references) add_noted(one, "reference");
    for (const LeftOut& one : view.left_out) lines.push_back({one.contender, one.reason});
    out +=
        fmt::format("{} {}, {} {} rays{}\n{}{}\n", view.view, view.size, view.rays, view.ray_kind,
                    view.clock == measure::TraceClock::kCpu
                        ? ", compared by CPU time: other processes disturbed too many traces"
                        : "",
                    table(lines),
                    any_self_reported ? "  self-reported: times of the program's own clock, which "
                                        "leave out the exchange with it\n"
                                      : "");
  }
  return out;
}

std::string describe_verdicts(const Analysis& analysis) {
  std::string out;
  if (analysis.failed > 0) {
    out = fmt::format("Hits:  {} of {} wrong or not built; these have no times\n", analysis.failed,
                      base::counted(analysis.cells, "cell"));
  } else {
    out = fmt::format("Hits:  {}, all verified\n", base::counted(analysis.possible(), "cell"));
  }
  if (analysis.without_rays > 0) {
    out += fmt::format("Rays:  {} of {} have no rays in their scenes\n", analysis.without_rays,
                       base::counted(analysis.cells, "cell"));
  }
  if (analysis.unsupported > 0) {
    out +=
        fmt::format("Cells: {} of {} have rays or primitives that the structure does not support\n",
                    analysis.unsupported, base::counted(analysis.cells, "cell"));
  }
  if (analysis.possible() > analysis.failed) {
    out +=
        analysis.reasons_for_care.empty()
            ? "Times: measured on a quiet machine, as precisely as requested\n"
            : fmt::format("Times: use with care: {}\n", fmt::join(analysis.reasons_for_care, "; "));
  }
  return out;
}

std::string describe(std::span<const Overhead> overheads) {
  std::vector<std::string> parts;
  for (const Overhead& each : overheads) {
    parts.push_back(fmt::format("{:.2g}%{} for {} ({})", 100.0 * each.part,
                                parts.empty() ? " of a contender's trace time" : "",
                                subject_of(each.path), each.cell));
  }
  return fmt::format("harness overhead: at most {}; trace_net_ms_median in results.csv excludes it",
                     fmt::join(parts, ", "));
}

std::string describe(std::span<const FrameSeries> all) {
  std::string text;
  for (const FrameSeries& series : all) {
    const FrameComparison& last = series.frames.back();
    const RebuildInterval interval = rebuild_interval(series);
    text += fmt::format(
        "{} in {}: in frame {} an update and its trace take {:.3g} ms, a build and its trace "
        "{:.3g} ms; the trace alone takes {:.3g} times as long as with a new structure; {}\n",
        series.contender, series.subject, last.frame, last.updated.total_ms(),
        last.built.total_ms(), last.trace.value,
        interval.is_all ? std::string("updates pay off in all frames measured")
        : interval.frames == 1
            ? std::string("rebuilding in each frame costs least")
            : fmt::format("one build for every {} frames costs least", interval.frames));
  }
  return text;
}

std::string summary(const Analysis& analysis) {
  return describe(analysis.views) + describe(analysis.frame_series) + "\n" +
         describe_verdicts(analysis);
}

}  // namespace beambench::analysis

// The analysis of runs: its statistics and its result.

#include "harness/analysis/analysis.hpp"

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "harness/analysis/names.hpp"
#include "harness/analysis/ratio.hpp"
#include "harness/analysis/standings.hpp"
#include "harness/python/bindings.hpp"
#include "harness/rays/ray_kind.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/json_text.hpp"

namespace beambench::python {
namespace {

namespace nb = nanobind;
using analysis::Median;
using analysis::TimeRatio;

/// A value and the ends of its interval.
using Ends = std::tuple<double, std::optional<double>, std::optional<double>>;
/// A ratio: the fields of `Ends`, whether the ratio is paired, the ends of its prediction interval,
/// and its error.
using RatioFields = std::tuple<double, std::optional<double>, std::optional<double>, bool,
                               std::optional<double>, std::optional<double>, std::optional<double>>;

std::optional<measure::Interval> interval_of(std::optional<double> low,
                                             std::optional<double> high) {
  return low && high ? std::optional(measure::Interval{*low, *high}) : std::nullopt;
}

Median median_of(const Ends& ends) {
  const auto& [value, low, high] = ends;
  return {value, interval_of(low, high)};
}

RatioFields fields_of(const TimeRatio& ratio) {
  using End = std::optional<double>;
  const auto& [value, interval, is_paired, prediction, error] = ratio;
  return {value,
          interval ? End(interval->low) : End(),
          interval ? End(interval->high) : End(),
          is_paired,
          prediction ? End(prediction->low) : End(),
          prediction ? End(prediction->high) : End(),
          error};
}

std::optional<RatioFields> known_fields_of(const std::optional<TimeRatio>& ratio) {
  return ratio ? std::optional(fields_of(*ratio)) : std::nullopt;
}

RatioFields mean_of(const std::vector<RatioFields>& list) {
  std::vector<TimeRatio> ratios;
  for (const auto& [value, low, high, is_paired, predicted_low, predicted_high, error] : list) {
    ratios.push_back({value, interval_of(low, high), is_paired,
                      interval_of(predicted_low, predicted_high), error});
  }
  return fields_of(analysis::geometric_mean(ratios));
}

using CellFields = std::tuple<std::string, std::string, std::string, std::string, int, std::string,
                              std::string, int>;
using NameFields = std::tuple<std::string, std::string, std::string>;

std::vector<NameFields> name_cells(const std::vector<CellFields>& list) {
  std::vector<analysis::NamedCell> cells;
  for (const CellFields& fields : list) {
    cells.push_back(std::make_from_tuple<analysis::NamedCell>(fields));
  }
  std::vector<NameFields> names;
  for (const auto& [contender, subject, view] : analysis::name_cells(cells)) {
    names.emplace_back(contender, subject, view);
  }
  return names;
}

}  // namespace

void bind_analysis(nb::module_& module) {
  module.def(
      "analyze",
      [](const nb::bytes& folder) {
        return json_text(analysis::to_json(analysis::analyze(measure::read_run(text_of(folder)))));
      },
      nb::arg("folder"), "Analyzes the log of a run; returns the text of analysis.json.");
  module.def("name_cells", &name_cells, nb::arg("cells"),
             "Returns contender, subject and view of each cell.");
  module.def(
      "without_order", [](const std::string& label) { return rays::divide_label(label).rays; },
      nb::arg("label"),
      "Returns the label of rays without their order: `diffuse` for `diffuse:order=sorted`.");
  module.attr("MARGIN") = analysis::kMargin;
  module.def(
      "paired_ratio",
      [](const analysis::TimesByRound& over, const analysis::TimesByRound& under) {
        return known_fields_of(analysis::paired_ratio(over, under));
      },
      nb::arg("over"), nb::arg("under"), "Returns the median ratio over the common rounds.");
  module.def(
      "block_ratio",
      [](const analysis::TimesByBlock& over, const analysis::TimesByBlock& under) {
        return known_fields_of(analysis::block_ratio(over, under));
      },
      nb::arg("over"), nb::arg("under"), "Returns the mean ratio over the common blocks.");
  module.def(
      "is_undisturbed",
      [](double trace_ms, double trace_cpu_ms) {
        measure::Repetition repetition{};
        repetition.trace_ms = trace_ms;
        repetition.trace_cpu_ms = trace_cpu_ms;
        return repetition.is_undisturbed();
      },
      nb::arg("trace_ms"), nb::arg("trace_cpu_ms"),
      "Returns whether a trace had the processor to itself.");
  module.def(
      "unpaired_ratio",
      [](const Ends& over, const Ends& under) {
        return fields_of(analysis::unpaired_ratio(median_of(over), median_of(under)));
      },
      nb::arg("over"), nb::arg("under"), "Returns the ratio of two medians.");
  module.def(
      "rank",
      [](double value, std::optional<double> low, std::optional<double> high, bool is_paired,
         std::optional<double> predicted_low, std::optional<double> predicted_high) {
        analysis::Standing standing{};
        standing.ratio = {value, interval_of(low, high), is_paired,
                          interval_of(predicted_low, predicted_high)};
        return std::string(to_string(standing.rank()));
      },
      nb::arg("value"), nb::arg("low").none(), nb::arg("high").none(), nb::arg("paired"),
      nb::arg("predicted_low").none(), nb::arg("predicted_high").none(),
      "Returns the rank of a contender by its ratio to the fastest.");
  module.def("geometric_mean", &mean_of, nb::arg("ratios"),
             "Returns the geometric mean of at least one ratio.");
  module.def(
      "median_interval",
      [](const std::vector<double>& samples) {
        const auto interval = measure::median_interval(samples);
        return interval ? std::optional(std::pair(interval->low, interval->high)) : std::nullopt;
      },
      nb::arg("samples"), "Returns the 95% interval of the median of some samples.");
  module.def(
      "break_even_rays",
      [](double build_ms, double ns_per_ray, double other_build_ms, double other_ns_per_ray) {
        return analysis::break_even_rays({build_ms, ns_per_ray},
                                         {other_build_ms, other_ns_per_ray});
      },
      nb::arg("build_ms"), nb::arg("ns_per_ray"), nb::arg("other_build_ms"),
      nb::arg("other_ns_per_ray"),
      "Returns the number of rays at which one contender overtakes another.");
}

}  // namespace beambench::python

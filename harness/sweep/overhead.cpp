#include "harness/sweep/overhead.hpp"

#include <map>

#include <fmt/format.h>

namespace beambench {
namespace {

using Json = nlohmann::ordered_json;

/// The trace times of the cells that share their rays.
struct View {
  std::optional<double> null_ms;
  std::optional<double> fastest_ms;
  std::string fastest;
};

std::string view_of(const Json& row) {
  return fmt::format("{}/{}/{}x{}/{}/{}", row.at("scene").get<std::string>(),
                     row.at("camera").get<std::string>(), row.at("width").get<int>(),
                     row.at("height").get<int>(), row.at("samples").get<int>(),
                     row.at("ray_kind").get<std::string>());
}

void add(View& view, const Json& row) {
  if (row.at("trace_ms_median").is_null()) return;
  const double trace_ms = row.at("trace_ms_median").get<double>();
  if (row.at("verdict") == "baseline") {
    view.null_ms = trace_ms;
  } else if (!view.fastest_ms || trace_ms < *view.fastest_ms) {
    view.fastest_ms = trace_ms;
    view.fastest = row.at("structure").get<std::string>();
  }
}

}  // namespace

std::optional<Overhead> largest_overhead(std::span<const Json> cells) {
  std::map<std::string, View> views;
  for (const Json& cell : cells) add(views[view_of(cell.at("row"))], cell.at("row"));
  std::optional<Overhead> largest;
  for (const auto& [name, view] : views) {
    if (!view.null_ms || !view.fastest_ms || *view.fastest_ms <= 0.0) continue;
    const double part = *view.null_ms / *view.fastest_ms;
    if (!largest || part > largest->part) largest = Overhead{name, view.fastest, part};
  }
  return largest;
}

std::string describe(const Overhead& overhead) {
  return fmt::format(
      "harness overhead (null): at most {:.2g}% of the fastest contender's trace time ({} on {})",
      100.0 * overhead.part, overhead.fastest, overhead.view);
}

Json to_json(const std::optional<Overhead>& overhead) {
  if (!overhead) return {};
  return {{"part", overhead->part}, {"fastest", overhead->fastest}, {"rays", overhead->view}};
}

}  // namespace beambench

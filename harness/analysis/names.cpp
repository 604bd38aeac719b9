#include "harness/analysis/names.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "harness/measure/plan.hpp"
#include "harness/rays/ray_kind.hpp"
#include "scenes/base/parameters.hpp"

namespace beambench::analysis {
namespace {

/// The flags that change which hits are found, with their defaults: whether edges are watertight,
/// and whether the backs of closed solids are left out. Names state all other values of these
/// flags.
constexpr std::array<std::pair<std::string_view, std::string_view>, 2> kFlagsOfHits{
    {{"robust", "true"}, {"backface_culling", "false"}}};

bool changes_hits(const std::string& name, const std::string& value) {
  return std::ranges::any_of(
      kFlagsOfHits, [&](const auto& flag) { return flag.first == name && flag.second != value; });
}

using Parameters = std::vector<std::pair<std::string, std::string>>;

/// Returns the parameters in the order of the record.
Parameters parameters_of(const NamedCell& cell) {
  return parse_spec(cell.structure + (cell.parameters.empty() ? "" : ":" + cell.parameters))
      .parameters;
}

/// The variants of one structure.
struct Variants {
  std::set<std::string> seen;
  /// The number of variants that have each value of each parameter.
  std::map<std::string, std::map<std::string, std::size_t>> counts;

  void add(const NamedCell& cell) {
    if (!seen.insert(cell.parameters).second) return;
    for (const auto& [name, value] : parameters_of(cell)) ++counts[name][value];
  }

  /// Returns whether variants differ in a parameter; a parameter that only some variants have also
  /// counts.
  bool differ_in(const std::string& name, const std::string& value) const {
    return counts.at(name).at(value) < seen.size();
  }
};

/// The differences among the cells of a run.
struct Differences {
  std::map<std::string, Variants> structures;
  std::map<std::string, std::set<std::string>> cameras;  ///< by scene
  std::set<int> samples;
  std::set<std::string> ray_kinds;  ///< without their order
  std::set<std::string_view> orders;
  std::set<std::string> machines;

  explicit Differences(std::span<const NamedCell> cells) {
    for (const NamedCell& cell : cells) {
      if (cell.parameter_sets == 1) structures[cell.structure].add(cell);
      cameras[cell.scene].insert(cell.camera);
      samples.insert(cell.samples);
      const auto [kind, order] = rays::divide_label(cell.ray_kind);
      ray_kinds.insert(kind);
      orders.insert(order);
      machines.insert(cell.machine_id);
    }
  }

  std::string contender(const NamedCell& cell) const {
    std::string label = cell.structure;
    if (cell.parameter_sets > 1) {
      label += fmt::format(" (best of {})", cell.parameter_sets);
    } else {
      for (const auto& [name, value] : parameters_of(cell)) {
        if (structures.at(cell.structure).differ_in(name, value) || changes_hits(name, value)) {
          label += fmt::format(" {}={}", name, value);
        }
      }
    }
    const bool is_sorted = rays::divide_label(cell.ray_kind).order == rays::kSortedOrder;
    return is_sorted && orders.size() > 1 ? label + ", sorted rays" : label;
  }

  std::string subject(const NamedCell& cell) const {
    std::string title = measure::shown_scene(cell.scene);
    const auto has_several = [](const auto& entry) { return entry.second.size() > 1; };
    if (std::ranges::any_of(cameras, has_several)) title += ", camera " + cell.camera;
    if (samples.size() > 1) title += fmt::format(", {} samples", cell.samples);
    if (ray_kinds.size() > 1) title += ", " + rays::divide_label(cell.ray_kind).rays + " rays";
    return title;
  }

  std::string machine(const NamedCell& cell) const {
    constexpr std::size_t kShownDigits = 8;
    if (machines.size() == 1) return "";
    return ", machine " + cell.machine_id.substr(0, kShownDigits);
  }
};

}  // namespace

std::vector<Names> name_cells(std::span<const NamedCell> cells) {
  const Differences differences(cells);
  std::vector<Names> names;
  names.reserve(cells.size());
  for (const NamedCell& cell : cells) {
    const std::string subject = differences.subject(cell);
    names.push_back({differences.contender(cell), subject, subject + differences.machine(cell)});
  }
  return names;
}

}  // namespace beambench::analysis

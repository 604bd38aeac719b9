#include "harness/sweep/overhead.hpp"

#include <fmt/format.h>

#include "harness/rays/ray_kind.hpp"

namespace beambench {
namespace {

using Json = nlohmann::ordered_json;

std::optional<double> part_of(const Json& row) {
  if (row.at("verdict") != "ok" || row.at("trace_ms_median").is_null()) return std::nullopt;
  if (row.at("query") == to_string(Query::kPicture)) return std::nullopt;  // shading is asked for
  const double trace_ms = row.at("trace_ms_median").get<double>();
  // A structure that is quicker than the harness's rays makes none of them: it has no such part.
  if (trace_ms <= row.at("harness_ms").get<double>()) return std::nullopt;
  return row.at("harness_ms").get<double>() / trace_ms;
}

}  // namespace

std::optional<Overhead> largest_overhead(std::span<const Json> cells) {
  std::optional<Overhead> largest;
  for (const Json& cell : cells) {
    const std::optional<double> part = part_of(cell.at("row"));
    if (part && (!largest || *part > largest->part)) {
      largest = Overhead{cell.at("name").get<std::string>(), *part};
    }
  }
  return largest;
}

std::string describe(const Overhead& overhead) {
  return fmt::format(
      "harness overhead: at most {:.2g}% of a contender's trace time ({}); trace_net_ms_median in "
      "results.csv is without it",
      100.0 * overhead.part, overhead.cell);
}

Json to_json(const std::optional<Overhead>& overhead) {
  if (!overhead) return {};
  return {{"part", overhead->part}, {"cell", overhead->cell}};
}

}  // namespace beambench

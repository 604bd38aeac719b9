#include "harness/bench/overhead.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/bench/record/cell_record.hpp"

namespace beambench::bench {
namespace {

using Json = nlohmann::ordered_json;

std::optional<Overhead> overhead_of(const Json& cell) {
  const Json& row = cell.at("row");
  if (row.at("verdict") != verify::to_string(verify::Verdict::kOk) ||
      row.at("trace_ms_median").is_null())
    return std::nullopt;
  const Json& path = row.at("query_path");
  if (path.is_null() || path == to_string(QueryPath::kImageOwn) ||
      path == to_string(QueryPath::kPicture)) {
    return std::nullopt;
  }
  const double trace_ms = row.at("trace_ms_median").get<double>();
  const double harness_ms = row.at("harness_ms").get<double>();
  // A plug-in that is quicker than making rays one by one makes none so, whatever it states.
  if (trace_ms <= harness_ms) return std::nullopt;
  return Overhead{path.get<std::string>(), cell.at("name").get<std::string>(),
                  harness_ms / trace_ms};
}

std::string_view subject_of(const std::string& path) {
  if (path == to_string(QueryPath::kImageSingle)) return "images by single rays";
  if (path == to_string(QueryPath::kImageSimd)) return "images by SIMD rays";
  return "lists of rays";
}

}  // namespace

std::vector<Overhead> largest_overheads(std::span<const Json> cells) {
  std::vector<Overhead> largest;
  for (const Json& cell : cells) {
    const std::optional<Overhead> found = overhead_of(cell);
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

std::string describe(std::span<const Overhead> overheads) {
  std::vector<std::string> parts;
  for (const Overhead& each : overheads) {
    parts.push_back(fmt::format("{:.2g}%{} for {} ({})", 100.0 * each.part,
                                parts.empty() ? " of a contender's trace time" : "",
                                subject_of(each.path), each.cell));
  }
  return fmt::format(
      "harness overhead: at most {}; trace_net_ms_median in results.csv is without it",
      fmt::join(parts, ", "));
}

Json to_json(std::span<const Overhead> overheads) {
  if (overheads.empty()) return {};
  Json json{{"part", overheads.front().part}, {"cell", overheads.front().cell}};
  for (const Overhead& each : overheads) {
    json["by_query_path"][each.path] = {{"part", each.part}, {"cell", each.cell}};
  }
  return json;
}

}  // namespace beambench::bench

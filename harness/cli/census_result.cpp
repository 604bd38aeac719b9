#include "harness/cli/census_result.hpp"

#include <utility>

#include <fmt/format.h>

#include "harness/cli/text.hpp"

namespace beambench {
namespace {

using Cells = std::vector<std::string>;

std::string number(std::uint64_t value) { return fmt::format("{}", value); }
std::string time(double ms) { return fmt::format("{:.4g} ms", ms); }

Cells row_of(const CensusResult& result) {
  const RayCensus& census = result.census;
  Cells row{result.scene,
            number(census.eye),
            number(census.eye_hits),
            number(census.reflected),
            number(census.refracted),
            number(census.shadow),
            format_share(census.shadow_hidden, census.shadow),
            format_share(census.shadow_cached, census.shadow_hidden),
            format_share(census.shadow_listed, census.shadow),
            time(result.build_ms),
            time(result.eye_ms),
            time(result.preparation_ms),
            time(result.picture_ms)};
  if (result.full) {
    row.push_back(number(census.too_faint));
    row.push_back(format_share(census.all_rays(), result.full->rays));
    row.push_back(fmt::format("{:.1f}%", 100.0 * result.picture_ms / result.full->picture_ms));
    row.push_back(fmt::format("{:.2f}", result.full->error));
  }
  return row;
}

}  // namespace

std::string census_text(const std::vector<CensusResult>& results) {
  Cells header{"scene",  "eye rays", "hits",  "reflected", "refracted", "shadow",  "hidden",
               "cached", "listed",   "build", "eye",       "lists",     "the rest"};
  if (!results.empty() && results.front().full) {
    for (const char* column : {"too faint", "of the rays", "of the rest", "error"}) {
      header.emplace_back(column);
    }
  }
  TextTable table(std::move(header));
  for (const CensusResult& result : results) table.add(row_of(result));
  return table.text();
}

nlohmann::ordered_json to_json(const CensusResult& result) {
  const RayCensus& census = result.census;
  nlohmann::ordered_json out{{"scene", result.scene},
                             {"lights", result.lights},
                             {"eye_rays", census.eye},
                             {"eye_hits", census.eye_hits},
                             {"reflected_rays", census.reflected},
                             {"refracted_rays", census.refracted},
                             {"secondary_hits", census.secondary_hits},
                             {"too_faint", census.too_faint},
                             {"shadow_rays", census.shadow},
                             {"shadow_hidden", census.shadow_hidden},
                             {"shadow_cached", census.shadow_cached},
                             {"shadow_listed", census.shadow_listed},
                             {"shadow_tests", census.shadow_tests},
                             {"shadow_queries", census.shadow_queries},
                             {"shadow_bytes", result.shadow_bytes},
                             {"build_ms", result.build_ms},
                             {"eye_ms", result.eye_ms},
                             {"preparation_ms", result.preparation_ms},
                             {"picture_ms", result.picture_ms}};
  if (result.full) {
    out["full_rays"] = result.full->rays;
    out["full_picture_ms"] = result.full->picture_ms;
    out["error"] = result.full->error;
  }
  return out;
}

}  // namespace beambench

#include "harness/cli/census_result.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "harness/cli/text.hpp"
#include "harness/render/ray_census.hpp"

namespace beambench::cli {
namespace {

using Cells = std::vector<std::string>;

std::string number(std::uint64_t value) { return fmt::format("{}", value); }
std::string time(double ms) { return fmt::format("{:.4g} ms", ms); }

Cells row_of(const CensusResult& result) {
  const render::RayCensus& census = result.census;
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

/// Above this a difference from a published count needs an explanation.
constexpr double kNotablePercent = 2.0;

/// One of our counts beside that of the literature.
struct Compared {
  std::string_view rays;
  std::uint64_t ours;
  std::uint64_t published;

  /// Nothing where there is nothing to be a percentage of.
  std::optional<double> percent() const {
    if (published == 0) return ours == 0 ? std::optional(0.0) : std::nullopt;
    return 100.0 * (static_cast<double>(ours) / static_cast<double>(published) - 1.0);
  }
  bool notable() const { return !percent() || std::abs(*percent()) > kNotablePercent; }
};

std::array<Compared, 4> compared(const render::RayCensus& ours,
                                 const render::PublishedCounts& theirs) {
  return {{{"eye_hits", ours.eye_hits, theirs.eye_hits},
           {"reflected", ours.reflected, theirs.reflected},
           {"refracted", ours.refracted + ours.totally_reflected, theirs.refracted},
           {"shadow", ours.shadow, theirs.shadow}}};
}

}  // namespace

std::string published_text(const std::vector<CensusResult>& results, const std::string& departure) {
  TextTable table({"scene", "rays", "here", "published", "difference", "remark"}, 2);
  bool any = false;
  for (const CensusResult& result : results) {
    const render::PublishedCounts* theirs = render::find_published_counts(result.scene);
    if (theirs == nullptr) continue;
    for (const Compared& each : compared(result.census, *theirs)) {
      if (each.ours == 0 && each.published == 0) continue;
      const auto percent = each.percent();
      const std::string remark = departure.empty() ? "unexplained" : "by " + departure;
      table.add({result.scene, std::string(each.rays), number(each.ours), number(each.published),
                 percent ? fmt::format("{:+.2f}%", *percent) : "-", each.notable() ? remark : ""});
      any = true;
    }
  }
  if (!any) return "";
  return "Beside the counts that Haines published with SPD 3.14 (refracted: rays that are "
         "reflected totally\nin place of it included):\n\n" +
         table.text();
}

nlohmann::ordered_json to_json_beside_published(const CensusResult& result) {
  nlohmann::ordered_json out = to_json(result);
  const render::PublishedCounts* theirs = render::find_published_counts(result.scene);
  if (theirs == nullptr) return out;
  for (const Compared& each : compared(result.census, *theirs)) {
    const auto percent = each.percent();
    out["published"][std::string(each.rays)] = {
        {"here", each.ours},
        {"published", each.published},
        {"difference_percent", percent ? nlohmann::ordered_json(*percent) : nullptr}};
  }
  return out;
}

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
  const render::RayCensus& census = result.census;
  nlohmann::ordered_json out{{"scene", result.scene},
                             {"lights", result.lights},
                             {"eye_rays", census.eye},
                             {"eye_hits", census.eye_hits},
                             {"reflected_rays", census.reflected},
                             {"refracted_rays", census.refracted},
                             {"totally_reflected", census.totally_reflected},
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

}  // namespace beambench::cli

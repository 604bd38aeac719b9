// beambench census: counts the rays of the whole ray tracer by kind.

#include "harness/thesis/census.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "harness/base/messages.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/text.hpp"
#include "harness/render/picture/image_file.hpp"
#include "harness/render/ray_census.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::cli {
namespace {

struct CensusRequest {
  std::vector<std::string> scenes;
  std::string structure = "sah-bvh";
  std::string rules = "image";
  std::string order = "rows";
  ImageRequest image;
  WhittedRequest whitted;
  std::string pictures;  ///< a folder; empty: do not write pictures
  bool count_work = false;
  bool json = false;
};

using thesis::CensusResult;

bool by_spd(const CensusRequest& request) { return request.rules == "spd"; }

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

/// The percentage above which a difference from a published count needs an explanation.
constexpr double kNotablePercent = 2.0;

/// One of our counts, and the published count.
struct Compared {
  std::string_view rays;
  std::uint64_t ours;
  std::uint64_t published;

  /// Returns the difference in percent; nothing if the published count is 0.
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

nlohmann::ordered_json to_json(const thesis::QueryWork& queries) {
  nlohmann::ordered_json out = queries.counters.by_name();
  out["rays"] = queries.rays;
  out["rays_that_hit"] = queries.rays_that_hit;
  return out;
}

nlohmann::ordered_json to_json(const CensusResult& result) {
  const render::RayCensus& census = result.census;
  nlohmann::ordered_json out{{"scene", result.scene}, {"lights", result.lights}};
  for (const render::CensusCount& each : render::kCensusCounts) out[each.name] = census.*each.count;
  out["shadow_bytes"] = result.shadow_bytes;
  out["build_ms"] = result.build_ms;
  out["eye_ms"] = result.eye_ms;
  out["preparation_ms"] = result.preparation_ms;
  out["picture_ms"] = result.picture_ms;
  if (result.work) {
    const accel::Statistics& built = result.work->statistics;
    out["size"] = {{"nodes", built.nodes},
                   {"leaves", built.leaves},
                   {"empty_leaves", built.empty_leaves},
                   {"references", built.references},
                   {"depth", built.depth},
                   {"bytes", built.bytes}};
    for (const auto& [name, value] : built.more) out["size"][name] = value;
    out["work"] = to_json(result.work->queries);
  }
  if (result.full) {
    out["full_rays"] = result.full->rays;
    out["full_picture_ms"] = result.full->picture_ms;
    out["error"] = result.full->error;
  }
  return out;
}

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
  return "Comparison with the counts that Haines published with SPD 3.14 (refracted includes rays "
         "that are\ntotally reflected instead):\n\n" +
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

std::string work_text(const std::vector<CensusResult>& results) {
  TextTable table({"scene", "work", "count", "per ray"}, 2);
  for (const CensusResult& result : results) {
    if (!result.work) continue;
    const auto rays = static_cast<double>(result.work->queries.rays);
    for (const auto& [name, count] : result.work->queries.counters.by_name()) {
      if (count == 0) continue;
      table.add({result.scene, name, number(count),
                 fmt::format("{:.4g}", static_cast<double>(count) / rays)});
    }
  }
  return table.text();
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

/// Returns the options that deviate from SPD's rules and so explain different counts.
std::string departure(const CensusRequest& request) {
  std::vector<std::string> options;
  const int published_depth = render::WhittedOptions{}.max_depth;
  if (request.whitted.max_depth != published_depth) {
    options.push_back(fmt::format("--depth {}", request.whitted.max_depth));
  }
  if (request.whitted.min_weight > 0.0) {
    options.push_back(fmt::format("--min-weight {}", request.whitted.min_weight));
  }
  return fmt::format("{}", fmt::join(options, ", "));
}

void print_text(const CensusRequest& request, const std::vector<CensusResult>& results) {
  fmt::print("{}, {} rules, depth {}, shadows by {}\n\n{}", request.structure, request.rules,
             request.whitted.max_depth, request.whitted.shadows, census_text(results));
  if (request.count_work) fmt::print("\n{}", work_text(results));
  if (!by_spd(request)) return;
  const std::string beside = published_text(results, departure(request));
  if (!beside.empty()) fmt::print("\n{}", beside);
}

void print_json(const CensusRequest& request, const std::vector<CensusResult>& results) {
  nlohmann::ordered_json out{{"structure", request.structure},
                             {"rules", request.rules},
                             {"depth", request.whitted.max_depth},
                             {"shadows", request.whitted.shadows},
                             {"order", request.order},
                             {"min_weight", request.whitted.min_weight},
                             {"threads", request.whitted.threads},
                             {"scenes", nlohmann::ordered_json::array()}};
  for (const CensusResult& result : results) {
    out["scenes"].push_back(by_spd(request) ? to_json_beside_published(result) : to_json(result));
  }
  fmt::print("{}\n", json_text(out));
}

thesis::CensusOptions options_of(const CensusRequest& request) {
  constexpr std::array<std::string_view, 2> kRules{"spd", "image"};
  base::place_of_name("rules", request.rules, kRules);
  if (by_spd(request) && (!request.image.resolution.empty() || request.image.samples != 1)) {
    throw InputError(
        "SPD's rules prescribe the rays, 513x513 through the corners of pixels; leave out "
        "--resolution and --samples");
  }
  const thesis::CensusOptions options{whitted_options(request.whitted), by_spd(request),
                                      render::parse_shading_order(request.order),
                                      request.whitted.threads, request.count_work};
  if (options.order != render::ShadingOrder::kRows && by_spd(request)) {
    throw InputError("SPD's rules prescribe rows of pixel corners; leave out --order");
  }
  return options;
}

void census(const CensusRequest& request) {
  const thesis::CensusOptions options = options_of(request);
  const accel::StructureChoice choice = choose_one("--accel", request.structure);
  if (!request.pictures.empty()) make_folder(request.pictures, "choose another with --pictures");
  std::vector<std::string> scenes = request.scenes;
  if (scenes.empty()) {
    for (const scenes::SceneInfo& info : scenes::scene_catalogue()) scenes.push_back(info.name);
  }
  base::Progress progress(scenes.size() * (options.whitted.min_weight > 0.0 ? 2 : 1));
  std::vector<CensusResult> results;
  results.reserve(scenes.size());
  for (const std::string& name : scenes) {
    const scenes::Scene scene = open_scene(name);
    CensusResult& result = results.emplace_back(
        thesis::take_census(choice, scene, choose_image(scene, request.image), options, progress));
    if (request.pictures.empty()) continue;
    render::write_image(std::filesystem::path(request.pictures) / picture_name(scene.name),
                        std::exchange(result.picture, render::Image(1, 1)));
  }
  progress.clear();
  if (!request.pictures.empty()) {
    base::print_message(
        stderr, fmt::format("{} in the folder '{}'\n", base::counted(results.size(), "picture"),
                            printable(request.pictures)));
  }
  request.json ? print_json(request, results) : print_text(request, results);
}

}  // namespace

void add_census_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand(
      "census", "Count the rays of whole pictures: primary, shadow, reflected, refracted");
  const auto request = std::make_shared<CensusRequest>();
  command->add_option(
      "SCENE", request->scenes,
      fmt::format("{}; several may be given (default: the whole catalogue)", kSceneHelp));
  command->add_option("--accel", request->structure, "Structure: NAME:parameter=value,...")
      ->capture_default_str();
  command
      ->add_option("--rules", request->rules,
                   "image: rays as for 'render'; spd: Haines's Standard Procedural Databases")
      ->capture_default_str();
  command
      ->add_option("--order", request->order,
                   "Order in which pixels are shaded, which affects shadow caches: rows, each with "
                   "a new cache; scan: rows with one cache, on one thread; beams: beam by beam, "
                   "with one cache, on one thread")
      ->capture_default_str();
  add_image_options(*command, request->image);
  add_whitted_options(*command, request->whitted);
  command
      ->add_option("--pictures", request->pictures,
                   "Also write each scene's picture to this folder, which is created if missing")
      ->type_name("DIR");
  command->add_flag("--count", request->count_work,
                    "Also count the structure's work over all rays, for shadow rays up to the "
                    "first object that they hit; times then include the counting");
  command->add_flag("--json", request->json, "Print JSON instead of text");
  command->footer(
      "The rules of SPD: 513x513 rays through the corners of pixels, maximum depth 5, no minimum\n"
      "weight, a mirror ray from all glass, even if it adds nothing to the picture, one ray at\n"
      "total reflection, no shadow ray to a light behind the surface; the counts that Haines\n"
      "published are printed for comparison. hidden: shadow rays that hit an opaque object; "
      "cached:\n"
      "hidden rays found by the shadow cache; listed: shadow rays decided by light buffers.\n"
      "Times: build; eye: primary rays; lists: light buffers; the rest, on --threads threads. "
      "With\n"
      "--min-weight, each picture is drawn again with all rays. too faint: rays not traced;\n"
      "of the rays, of the rest: share of the second picture's rays and time; error: RMS\n"
      "difference of the pictures on a 0-255 scale.\n"
      "Examples:\n"
      "  beambench census tetra teapot:n=12 --rules spd\n"
      "  beambench census escena1 --accel beam --resolution 640x480 --shadows cache --json\n"
      "  beambench census maceta --accel beam --shadows cache --order beams\n"
      "  beambench census mount --min-weight 0.01\n"
      "  beambench census --resolution 640x480 --threads 2 --pictures drawn");
  command->callback([request] { census(*request); });
}

}  // namespace beambench::cli

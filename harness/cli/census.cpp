// beambench census: how many rays of which kind the whole ray tracer takes.

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/picture_folder.hpp"
#include "harness/cli/text.hpp"
#include "harness/cli/whitted_request.hpp"
#include "harness/picture/image_file.hpp"
#include "harness/plugin/check_hits.hpp"
#include "harness/rays/answers.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/error.hpp"

namespace beambench {
namespace {

struct Request {
  std::vector<std::string> scenes;
  std::string structure = "sah-bvh";
  std::string rules = "image";
  ImageRequest image;
  WhittedRequest whitted;
  std::string pictures;  ///< a folder; empty: none are kept
  bool json = false;
};

/// What one scene took.
struct Result {
  std::string scene;
  RayCensus census;
  std::size_t lights;
  double build_ms;
  double eye_ms;
  double preparation_ms;  ///< light buffers
  double picture_ms;      ///< all but the eye's rays
  std::size_t shadow_bytes;
};

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

double all_ms(const Result& result) {
  return result.build_ms + result.eye_ms + result.preparation_ms + result.picture_ms;
}

/// The eye's rays by the structure's own way for images, or one by one at the corners of pixels.
HitBuffer eye_hits(const Accelerator& structure, const EyeRays& rays, const PrimaryRays* image) {
  HitBuffer hits(rays.width, rays.height, rays.samples);
  if (image != nullptr) {
    structure.trace(*image, hits);
    return hits;
  }
  for (int y = 0; y < rays.height; ++y) {
    for (int x = 0; x < rays.width; ++x) {
      hits.set(hits.index(x, y, 0), structure.closest_hit(rays.ray(x, y, 0)));
    }
  }
  return hits;
}

Result take_census(const Request& request, const std::string& name, Progress& progress) {
  const StructureChoice choice = choose_one("--accel", request.structure);
  const Scene scene = open_scene(name);
  const ImageOfRays image = choose_image(scene, request.image);
  const PrimaryRays primary = choose_rays(scene, request.image);
  const bool spd = request.rules == "spd";
  progress.start(fmt::format("{} over {}", choice.info().name, scene.name));

  Result result{scene.name, {}, scene.lights.size(), 0, 0, 0, 0, 0};
  Clock::time_point begin = Clock::now();
  const auto structure = choice.build(scene, workload_of(image, primary));
  result.build_ms = milliseconds_since(begin);
  const EyeRays rays = spd ? corner_rays(image.camera) : eye_rays(primary);
  begin = Clock::now();
  const HitBuffer hits = eye_hits(*structure, rays, spd ? nullptr : &primary);
  result.eye_ms = milliseconds_since(begin);
  check_hits(hits, scene, choice.info());
  begin = Clock::now();
  const Whitted tracer(scene, *structure, whitted_options(request.whitted));
  result.preparation_ms = milliseconds_since(begin);
  begin = Clock::now();
  const WhittedPicture picture = watched_picture(tracer, rays, hits, request.whitted, progress);
  result.picture_ms = milliseconds_since(begin);
  result.census = picture.census;
  result.shadow_bytes = tracer.shadows().memory_bytes();
  if (!request.pictures.empty()) {
    write_image(std::filesystem::path(request.pictures) / picture_name(scene.name), picture.image);
  }
  progress.finish(fmt::format("{} rays in {}",
                              picture.census.eye + picture.census.reflected +
                                  picture.census.refracted + picture.census.shadow,
                              format_duration(1e-3 * all_ms(result))));
  return result;
}

void print_text(const Request& request, const std::vector<Result>& results) {
  TextTable table({"scene", "eye rays", "hits", "reflected", "refracted", "shadow", "hidden",
                   "cached", "listed", "too faint", "build", "eye", "lists", "the rest"});
  for (const Result& result : results) {
    const RayCensus& census = result.census;
    const auto number = [](std::uint64_t value) { return fmt::format("{}", value); };
    const auto time = [](double ms) { return fmt::format("{:.4g} ms", ms); };
    table.add({result.scene, number(census.eye), number(census.eye_hits), number(census.reflected),
               number(census.refracted), number(census.shadow),
               format_share(census.shadow_hidden, census.shadow),
               format_share(census.shadow_cached, census.shadow_hidden),
               format_share(census.shadow_listed, census.shadow), number(census.too_faint),
               time(result.build_ms), time(result.eye_ms), time(result.preparation_ms),
               time(result.picture_ms)});
  }
  fmt::print("{}, {} rules, depth {}, shadows by {}\n\n{}", request.structure, request.rules,
             request.whitted.max_depth, request.whitted.shadows, table.text());
}

void print_json(const Request& request, const std::vector<Result>& results) {
  nlohmann::ordered_json out{{"structure", request.structure},
                             {"rules", request.rules},
                             {"depth", request.whitted.max_depth},
                             {"shadows", request.whitted.shadows},
                             {"least_weight", request.whitted.least_weight},
                             {"threads", request.whitted.threads},
                             {"scenes", nlohmann::ordered_json::array()}};
  for (const Result& result : results) {
    const RayCensus& census = result.census;
    out["scenes"].push_back({{"scene", result.scene},
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
                             {"picture_ms", result.picture_ms}});
  }
  fmt::print("{}\n", out.dump(2));
}

void census(const Request& request) {
  if (request.rules != "spd" && request.rules != "image") {
    throw InputError(
        fmt::format("there are no rules '{}'; choose from: spd, image", request.rules));
  }
  if (request.rules == "spd" && (!request.image.resolution.empty() || request.image.samples != 1)) {
    throw InputError(
        "the rules of SPD fix the rays, 513x513 through the corners of pixels; "
        "leave out --resolution and --samples");
  }
  choose_one("--accel", request.structure);
  whitted_options(request.whitted);
  if (!request.pictures.empty()) make_picture_folder(request.pictures);
  std::vector<std::string> scenes = request.scenes;
  if (scenes.empty()) {
    for (const SceneInfo& info : scene_catalogue()) scenes.push_back(info.name);
  }
  Progress progress(scenes.size());
  std::vector<Result> results;
  results.reserve(scenes.size());
  for (const std::string& name : scenes) {
    results.push_back(take_census(request, name, progress));
  }
  progress.clear();
  request.json ? print_json(request, results) : print_text(request, results);
}

}  // namespace

void add_census_command(CLI::App& app, int&) {
  CLI::App* command =
      app.add_subcommand("census", "Count the rays of whole pictures: eye, shadow, mirror, glass");
  const auto request = std::make_shared<Request>();
  command->add_option(
      "SCENE", request->scenes,
      "Catalogue names, or paths of NFF or mesh files (default: the whole catalogue)");
  command->add_option("--accel", request->structure, "Structure: NAME:parameter=value,...")
      ->capture_default_str();
  command
      ->add_option("--rules", request->rules,
                   "image: rays as for 'render'; spd: Haines's Standard Procedural Databases")
      ->capture_default_str();
  add_image_options(*command, request->image);
  add_whitted_options(*command, request->whitted);
  command->add_option("--pictures", request->pictures,
                      "Write the picture of each scene to this folder, too");
  command->add_flag("--json", request->json, "Print JSON instead of text");
  command->footer(
      "The rules of SPD: 513x513 rays through the corners of pixels, rays of depth 5, none left "
      "out\n"
      "for being faint, no shadow ray to a light behind the surface. hidden: of the shadow rays,\n"
      "those that something opaque stops; cached: of these, what the shadow cache knew; listed: "
      "of\n"
      "the shadow rays, what light buffers answered; too faint: not traced for --least-weight.\n"
      "Times: building, the eye's rays, making light buffers, the rest (on --threads).\n"
      "Examples:\n"
      "  beambench census tetra teapot:n=12 --rules spd\n"
      "  beambench census escena1 --accel beam --resolution 640x480 --shadows cache --json\n"
      "  beambench census --resolution 1280x1024 --threads 2 --pictures whitted");
  command->callback([request] { census(*request); });
}

}  // namespace beambench

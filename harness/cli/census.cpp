// beambench census: how many rays of which kind the whole ray tracer takes.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "harness/base/counted.hpp"
#include "harness/base/stopwatch.hpp"
#include "harness/cli/census_result.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/picture_folder.hpp"
#include "harness/cli/whitted_request.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/picture/image_file.hpp"
#include "harness/render/shading_order.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/core/error.hpp"

namespace beambench::cli {
namespace {

struct Request {
  std::vector<std::string> scenes;
  std::string structure = "sah-bvh";
  std::string rules = "image";
  std::string order = "rows";
  ImageRequest image;
  WhittedRequest whitted;
  std::string pictures;  ///< a folder; empty: none are kept
  bool json = false;
};

/// The eye's rays by the structure's own way for images, or one by one at the corners of pixels.
accel::HitBuffer eye_hits(const accel::Accelerator& structure, const render::CameraRays& rays,
                          const accel::PrimaryRays* image) {
  accel::HitBuffer hits(rays.width, rays.height, rays.samples);
  if (image != nullptr) {
    structure.trace(*image, hits, nullptr);
    return hits;
  }
  for (int y = 0; y < rays.height; ++y) {
    for (int x = 0; x < rays.width; ++x) {
      hits.set(hits.index(x, y, 0), structure.closest_hit(rays.ray(x, y, 0), nullptr));
    }
  }
  return hits;
}

bool by_spd(const Request& request) { return request.rules == "spd"; }

render::WhittedOptions options_of(const Request& request, const WhittedRequest& whitted) {
  render::WhittedOptions options = whitted_options(whitted);
  options.glass_always_mirrors = by_spd(request);
  return options;
}

/// The picture in the order that was asked for.
render::WhittedPicture draw(const render::Whitted& tracer, const accel::Accelerator& structure,
                            const accel::PrimaryRays& primary, const render::CameraRays& rays,
                            const accel::HitBuffer& hits, const Request& request,
                            base::Progress& progress) {
  const render::ShadingOrder order = render::parse_shading_order(request.order);
  if (order == render::ShadingOrder::kRows) {
    return watched_picture(tracer, rays, hits, request.whitted, progress);
  }
  const auto places = order == render::ShadingOrder::kBeams ? render::beam_order(structure, primary)
                                                            : render::scan_order(primary);
  return render::whitted_picture_along(places, tracer, rays, hits,
                                       [&](double part) { progress.advance(part); });
}

/// The picture without `least_weight`, and how far the one with it is from it.
FullPicture draw_full(const scenes::Scene& scene, const accel::Accelerator& structure,
                      const rays::HitCheck& check, const render::CameraRays& rays,
                      const accel::HitBuffer& hits, const Request& request,
                      const render::Image& picture, base::Progress& progress) {
  WhittedRequest whitted = request.whitted;
  whitted.least_weight = 0.0;
  progress.start(fmt::format("{} without --least-weight", scene.name));
  const render::Whitted tracer(scene, structure, options_of(request, whitted), check);
  const base::Stopwatch stopwatch;
  const render::WhittedPicture full = watched_picture(tracer, rays, hits, whitted, progress);
  const double picture_ms = stopwatch.milliseconds();
  progress.finish(fmt::format("{} rays", full.census.all_rays()));
  return {full.census.all_rays(), picture_ms, render::root_mean_square_error(picture, full.image)};
}

CensusResult take_census(const Request& request, const std::string& name,
                         base::Progress& progress) {
  const accel::StructureChoice choice = choose_one("--accel", request.structure);
  const scenes::Scene scene = open_scene(name);
  const rays::ImageOfRays image = choose_image(scene, request.image);
  const accel::PrimaryRays primary = choose_rays(scene, request.image);
  const bool spd = by_spd(request);
  progress.start(fmt::format("{} over {}", choice.info().name, scene.name));

  CensusResult result{scene.name, scene.lights.size(), {}, 0, 0, 0, 0, 0, {}};
  const base::Stopwatch all;
  base::Stopwatch stopwatch;
  const auto structure = choice.build(scene, rays::workload_of(image, primary));
  result.build_ms = stopwatch.milliseconds();
  const render::CameraRays rays =
      spd ? render::corner_rays(image.camera) : render::camera_rays(primary);
  stopwatch = {};
  const accel::HitBuffer hits = eye_hits(*structure, rays, spd ? nullptr : &primary);
  result.eye_ms = stopwatch.milliseconds();
  const rays::HitCheck check(scene, choice);
  check.require(hits, rays.ray);
  stopwatch = {};
  const render::Whitted tracer(scene, *structure, options_of(request, request.whitted), check);
  result.preparation_ms = stopwatch.milliseconds();
  stopwatch = {};
  const render::WhittedPicture picture =
      draw(tracer, *structure, primary, rays, hits, request, progress);
  result.picture_ms = stopwatch.milliseconds();
  result.census = picture.census;
  result.shadow_bytes = tracer.shadows().memory_bytes();
  if (!request.pictures.empty()) {
    render::write_image(std::filesystem::path(request.pictures) / picture_name(scene.name),
                        picture.image);
  }
  progress.finish(fmt::format("{} rays in {}", picture.census.all_rays(),
                              base::format_duration(all.seconds())));
  if (request.whitted.least_weight > 0.0) {
    result.full = draw_full(scene, *structure, check, rays, hits, request, picture.image, progress);
  }
  return result;
}

/// How the request departs from the rules of SPD, which explains other counts than the published.
std::string departure(const Request& request) {
  std::vector<std::string> ways;
  const int published_depth = render::WhittedOptions{}.max_depth;
  if (request.whitted.max_depth != published_depth) {
    ways.push_back(fmt::format("--depth {}", request.whitted.max_depth));
  }
  if (request.whitted.least_weight > 0.0) {
    ways.push_back(fmt::format("--least-weight {}", request.whitted.least_weight));
  }
  return fmt::format("{}", fmt::join(ways, ", "));
}

void print_text(const Request& request, const std::vector<CensusResult>& results) {
  fmt::print("{}, {} rules, depth {}, shadows by {}\n\n{}", request.structure, request.rules,
             request.whitted.max_depth, request.whitted.shadows, census_text(results));
  if (!by_spd(request)) return;
  const std::string beside = published_text(results, departure(request));
  if (!beside.empty()) fmt::print("\n{}", beside);
}

void print_json(const Request& request, const std::vector<CensusResult>& results) {
  nlohmann::ordered_json out{{"structure", request.structure},
                             {"rules", request.rules},
                             {"depth", request.whitted.max_depth},
                             {"shadows", request.whitted.shadows},
                             {"order", request.order},
                             {"least_weight", request.whitted.least_weight},
                             {"threads", request.whitted.threads},
                             {"scenes", nlohmann::ordered_json::array()}};
  for (const CensusResult& result : results) {
    out["scenes"].push_back(by_spd(request) ? to_json_beside_published(result) : to_json(result));
  }
  fmt::print("{}\n", out.dump(2));
}

void census(const Request& request) {
  if (!by_spd(request) && request.rules != "image") {
    throw InputError(
        fmt::format("there are no rules '{}'; choose from: spd, image", request.rules));
  }
  if (by_spd(request) && (!request.image.resolution.empty() || request.image.samples != 1)) {
    throw InputError(
        "the rules of SPD fix the rays, 513x513 through the corners of pixels; "
        "leave out --resolution and --samples");
  }
  if (render::parse_shading_order(request.order) != render::ShadingOrder::kRows &&
      by_spd(request)) {
    throw InputError("the rules of SPD have rows of corners of pixels; leave out --order");
  }
  choose_one("--accel", request.structure);
  whitted_options(request.whitted);
  if (!request.pictures.empty()) make_picture_folder(request.pictures);
  std::vector<std::string> scenes = request.scenes;
  if (scenes.empty()) {
    for (const scenes::SceneInfo& info : scenes::scene_catalogue()) scenes.push_back(info.name);
  }
  const bool twice = request.whitted.least_weight > 0.0;
  base::Progress progress(scenes.size() * (twice ? 2 : 1));
  std::vector<CensusResult> results;
  results.reserve(scenes.size());
  for (const std::string& name : scenes) {
    results.push_back(take_census(request, name, progress));
  }
  progress.clear();
  if (!request.pictures.empty()) {
    fmt::print(stderr, "{} in the folder '{}'\n", base::counted(results.size(), "picture"),
               request.pictures);
  }
  request.json ? print_json(request, results) : print_text(request, results);
}

}  // namespace

void add_census_command(CLI::App& app, int&) {
  CLI::App* command =
      app.add_subcommand("census", "Count the rays of whole pictures: eye, shadow, mirror, glass");
  const auto request = std::make_shared<Request>();
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
                   "In which order pixels are shaded, which a shadow cache depends on: rows, the "
                   "cache begins anew in each; scan: along the rows with one cache, on one thread; "
                   "beams: the same, beam by beam")
      ->capture_default_str();
  add_image_options(*command, request->image);
  add_whitted_options(*command, request->whitted);
  command
      ->add_option("--pictures", request->pictures,
                   "Write each scene's picture, too: to this folder, which is made")
      ->type_name("DIR");
  command->add_flag("--json", request->json, "Print JSON instead of text");
  command->footer(
      "The rules of SPD: 513x513 rays through the corners of pixels, rays of depth 5, none left "
      "out\n"
      "for being faint, a mirror ray from all glass, even where the picture takes nothing from "
      "it,\n"
      "one ray at total reflection, no shadow ray to a light behind the surface; the counts that\n"
      "Haines published are printed beside. hidden: of the shadow rays,\n"
      "those that something opaque stops; cached: of these, what the shadow cache knew; listed: "
      "of\n"
      "the shadow rays, what light buffers answered. Times: building, the eye's rays, making "
      "light\n"
      "buffers, the rest (on --threads). With --least-weight each picture is drawn once more "
      "without:\n"
      "too faint: not traced; of the rays, of the rest: how much of its rays and time were "
      "needed;\n"
      "error: the root mean square of the pictures' difference, of 255.\n"
      "Examples:\n"
      "  beambench census tetra teapot:n=12 --rules spd\n"
      "  beambench census escena1 --accel beam --resolution 640x480 --shadows cache --json\n"
      "  beambench census maceta --accel beam --shadows cache --order beams\n"
      "  beambench census mount --least-weight 0.01\n"
      "  beambench census --resolution 1280x1024 --threads 2 --pictures drawn");
  command->callback([request] { census(*request); });
}

}  // namespace beambench::cli

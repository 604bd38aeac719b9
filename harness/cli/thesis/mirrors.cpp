// beambench mirrors: traces reflections in planar mirrors by beams and by individual reflected
// rays.

#include "harness/thesis/mirrors.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accel/beam/beam_tracer.hpp"
#include "harness/base/messages.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/text.hpp"
#include "harness/rays/hit_check.hpp"
#include "scenes/base/json_text.hpp"

namespace beambench::cli {
namespace {

struct MirrorsRequest {
  std::string scene;
  std::string structure = "beam";
  ImageRequest image{"640x480", {}, 1};
  int repetitions = 5;
  bool json = false;
};

double ratio(const thesis::MirrorResult& result) { return result.rays_ms / result.beams_ms; }

void print_text(const scenes::Scene& scene, const MirrorsRequest& request,
                const thesis::MirrorComparison& found) {
  fmt::print("{}: {}, {} seen at {}, {}\n\n", scene.name,
             base::counted(found.mirrors, "planar mirror"), found.seen.size(),
             request.image.resolution, request.structure);
  TextTable table({"mirror", "polygons", "samples", "that hit", "rays", "beams", "rays/beams"});
  const auto add = [&](std::string name, const thesis::MirrorResult& result) {
    table.add({std::move(name), fmt::format("{}", result.polygons),
               fmt::format("{}", result.samples), format_share(result.hits, result.samples),
               fmt::format("{:.4g} ms", result.rays_ms), fmt::format("{:.4g} ms", result.beams_ms),
               fmt::format("{:.2f}", ratio(result))});
  };
  thesis::MirrorResult all;
  for (const thesis::MirrorResult& result : found.seen) {
    add(fmt::format("{}", &result - found.seen.data() + 1), result);
    all += result;
  }
  if (found.seen.size() > 1) add("all", all);
  fmt::print("{}", table.text());
}

void print_json(const scenes::Scene& scene, const MirrorsRequest& request,
                const thesis::MirrorComparison& found) {
  nlohmann::ordered_json out{{"scene", scene.name},
                             {"structure", request.structure},
                             {"resolution", request.image.resolution},
                             {"samples", request.image.samples},
                             {"repetitions", request.repetitions},
                             {"planar_mirrors", found.mirrors},
                             {"seen", nlohmann::ordered_json::array()}};
  for (const thesis::MirrorResult& result : found.seen) {
    out["seen"].push_back({{"polygons", result.polygons},
                           {"samples", result.samples},
                           {"hits", result.hits},
                           {"different", result.different},
                           {"rays_ms", result.rays_ms},
                           {"beams_ms", result.beams_ms}});
  }
  fmt::print("{}\n", json_text(out));
}

/// Returns false if beams and rays found different hits.
bool show_mirrors(const MirrorsRequest& request) {
  const accel::StructureChoice choice = choose_one("--accel", request.structure);
  const scenes::Scene scene = open_scene(request.scene);
  const rays::ImageOfRays image = choose_image(scene, request.image);
  const accel::PrimaryRays rays = image.rays();
  const auto built = accel::beam::build_beam_tracer(choice, scene, rays::workload_of(image, rays));
  const accel::beam::BeamTracer& tracer = *built;
  accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
  tracer.closest_hits(rays, hits, {});
  rays::HitCheck(scene, choice).require(hits, rays);
  const auto found = thesis::compare_mirrors(tracer, scene, rays, hits, request.repetitions);
  request.json ? print_json(scene, request, found) : print_text(scene, request, found);
  return std::ranges::all_of(found.seen, [](const auto& each) { return each.different == 0; });
}

}  // namespace

void add_mirrors_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("mirrors", "Compare beams and single rays for planar mirrors");
  const auto request = std::make_shared<MirrorsRequest>();
  add_scene_option(*command, request->scene);
  command->add_option("--accel", request->structure, "beam, with parameters where wanted")
      ->capture_default_str();
  add_image_options(*command, request->image);
  command->add_option("--repetitions", request->repetitions, "How often each method is timed")
      ->capture_default_str()
      ->check(CLI::Range(1, 1000));
  command->add_flag("--json", request->json, "Print JSON instead of text");
  command->footer(
      "A planar mirror shows what a virtual eye behind it sees (Heckbert and Hanrahan 1984). The\n"
      "reflected rays are traced in beams, the thesis's first line of future work, and one by one\n"
      "through the same octree. Coplanar flat polygons that reflect are one mirror.\n"
      "Exits with 1 if beams and rays find different hits.\n"
      "Examples:\n"
      "  beambench mirrors teapot\n"
      "  beambench mirrors habitacion --accel beam:max_level=7,handover=48 --resolution 320x200\n"
      "  beambench mirrors teapot:n=3 --accel beam:max_level=6 --json");
  command->callback([request, &exit_code] {
    exit_code = show_mirrors(*request) ? base::kSuccess : base::kMismatch;
  });
}

}  // namespace beambench::cli

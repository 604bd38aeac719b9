// beambench mirrors: traces what planar mirrors and planar glass show, with beams and with
// individual rays.

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
  fmt::print("{}: {}, {} seen, and {}, {} seen, at {}, {}\n\n", scene.name,
             base::counted(found.mirrors, "planar mirror"), found.seen.size(),
             base::counted(found.glass, "plane") + " of glass", found.seen_through.size(),
             request.image.resolution, request.structure);
  TextTable table({"", "polygons", "samples", "that hit", "rays", "beams", "rays/beams"});
  const auto add = [&](std::string name, const thesis::MirrorResult& result) {
    table.add({std::move(name), fmt::format("{}", result.polygons),
               fmt::format("{}", result.samples), format_share(result.hits, result.samples),
               fmt::format("{:.4g} ms", result.rays_ms), fmt::format("{:.4g} ms", result.beams_ms),
               fmt::format("{:.2f}", ratio(result))});
  };
  thesis::MirrorResult mirrors;
  for (const thesis::MirrorResult& result : found.seen) {
    add(fmt::format("mirror {}", &result - found.seen.data() + 1), result);
    mirrors += result;
  }
  if (found.seen.size() > 1) add("all mirrors", mirrors);
  thesis::GlassResult glass;
  for (const thesis::GlassResult& result : found.seen_through) {
    add(fmt::format("glass {}", &result - found.seen_through.data() + 1), result);
    glass += result;
  }
  if (found.seen_through.size() > 1) add("all glass", glass);
  fmt::print("{}", table.text());
  if (found.seen_through.empty()) return;

  fmt::print("\nRefracted rays by the angle at which the camera's rays meet the glass:\n");
  TextTable angles({"angle", "samples", "traced alone, outside beams"});
  int from = 0;
  for (std::size_t i = 0; i < glass.by_angle.size(); ++i) {
    const auto& [samples, alone] = glass.by_angle[i];
    const int to = thesis::kIncidence[i];
    if (samples > 0) {
      angles.add({fmt::format("{} to {} degrees", from, to), fmt::format("{}", samples),
                  format_share(alone, samples)});
    }
    from = to;
  }
  fmt::print("{}", angles.text());
}

nlohmann::ordered_json json_of(const thesis::MirrorResult& result) {
  return {{"polygons", result.polygons}, {"samples", result.samples},
          {"hits", result.hits},         {"different", result.different},
          {"rays_ms", result.rays_ms},   {"beams_ms", result.beams_ms}};
}

void print_json(const scenes::Scene& scene, const MirrorsRequest& request,
                const thesis::MirrorComparison& found) {
  nlohmann::ordered_json out{{"scene", scene.name},
                             {"structure", request.structure},
                             {"resolution", request.image.resolution},
                             {"samples", request.image.samples},
                             {"repetitions", request.repetitions},
                             {"planar_mirrors", found.mirrors},
                             {"seen", nlohmann::ordered_json::array()},
                             {"planar_glass", found.glass},
                             {"seen_through", nlohmann::ordered_json::array()}};
  for (const thesis::MirrorResult& result : found.seen) out["seen"].push_back(json_of(result));
  for (const thesis::GlassResult& result : found.seen_through) {
    nlohmann::ordered_json& glass = out["seen_through"].emplace_back(json_of(result));
    for (std::size_t i = 0; i < result.by_angle.size(); ++i) {
      glass["by_angle"].push_back({{"degrees_below", thesis::kIncidence[i]},
                                   {"samples", result.by_angle[i].samples},
                                   {"alone", result.by_angle[i].alone}});
    }
  }
  fmt::print("{}\n", json_text(out));
}

/// Prints the comparison; returns whether beams and rays found the same hits.
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
  const auto is_same = [](const thesis::MirrorResult& each) { return each.different == 0; };
  return std::ranges::all_of(found.seen, is_same) &&
         std::ranges::all_of(found.seen_through, is_same);
}

}  // namespace

void add_mirrors_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("mirrors", "Compare beams and single rays at planar mirrors and glass");
  const auto request = std::make_shared<MirrorsRequest>();
  add_scene_option(*command, request->scene);
  command->add_option("--accel", request->structure, "beam, with optional parameters")
      ->capture_default_str();
  add_image_options(*command, request->image);
  command->add_option("--repetitions", request->repetitions, "Number of times each method is timed")
      ->capture_default_str()
      ->check(whole_number_in(1, 1000));
  command->add_flag("--json", request->json, "Print JSON instead of text");
  command->footer(
      "A planar mirror shows what a virtual eye behind it sees (Heckbert and Hanrahan 1984). The\n"
      "reflected rays are traced in beams, the thesis's first line of future work, and one by one\n"
      "through the same octree. Coplanar flat polygons that reflect are one mirror. Rays\n"
      "refracted by planar glass are traced likewise; they have no common point, and those\n"
      "outside beams are traced alone.\n"
      "Exits with 1 if beams and rays find different hits.\n"
      "Examples:\n"
      "  beambench mirrors teapot\n"
      "  beambench mirrors aquarium\n"
      "  beambench mirrors habitacion --accel beam:max_level=7,handover=48 --resolution 320x200\n"
      "  beambench mirrors teapot:n=3 --accel beam:max_level=6 --json");
  command->callback([request, &exit_code] {
    exit_code = show_mirrors(*request) ? base::kSuccess : base::kMismatch;
  });
}

}  // namespace beambench::cli

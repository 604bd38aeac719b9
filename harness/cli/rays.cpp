// beambench rays: describes and saves a set of rays.

#include <cstdio>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/base/messages.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/text.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/ray_file.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/verify/differ.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/json_text.hpp"

namespace beambench::cli {
namespace {

using Json = nlohmann::ordered_json;

struct RaysRequest {
  std::string scene;
  std::string rays = "primary";
  ImageRequest image;
  std::string file;
  bool json = false;
};

/// Returns the rays as a list; the rays of an image are also saved as a list.
rays::RaySet as_list(const scenes::Scene& scene, const rays::TraceInput& input) {
  if (input.list() != nullptr) return *input.list();
  rays::RaySet set{{}, input.label(), input.query(), input.seed(), scenes::scene_hash(scene)};
  set.rays.reserve(input.size());
  for (std::size_t i = 0; i < input.size(); ++i) set.rays.push_back(input.ray(i));
  return set;
}

Json note_of(const scenes::Scene& scene, const rays::ImageOfRays& image,
             const rays::TraceInput& input) {
  return {{"scene", scene.name},
          {"ray_kind", input.label()},
          {"camera", image.camera.name},
          {"resolution", rays::to_string(image.resolution)},
          {"samples", image.samples}};
}

void print_facts(const RaysRequest& request, const scenes::Scene& scene,
                 const rays::ImageOfRays& image, const rays::TraceInput& input) {
  const std::uint64_t hits = verify::ReferenceHits(scene, input).hit_count();
  const bool any = input.query() == rays::Query::kAnyHit;
  if (request.json) {
    Json out = note_of(scene, image, input);
    out["query"] = rays::to_string(input.query());
    out["rays"] = input.size();
    out["seed"] = input.seed();
    out["hash"] = rays::hex_digits(rays::fingerprint(input));
    out[any ? "occluded_share" : "hit_share"] =
        static_cast<double>(hits) / static_cast<double>(input.size());
    out["coherence"] = rays::coherence(input);
    fmt::print("{}\n", json_text(out));
  } else {
    fmt::print("{} {} rays over {}, {}\n", input.size(), input.label(), scene.name,
               rays::to_string(image.resolution));
    fmt::print("  {}  {}\n", any ? "occluded " : "that hit ", format_share(hits, input.size()));
    fmt::print("  coherence  {:.4f}\n", rays::coherence(input));
    fmt::print("  hash       {}\n", rays::hex_digits(rays::fingerprint(input)));
  }
  if (const auto warning = rays::share_warning(input, hits)) {
    base::print_message(stderr, fmt::format("beambench: warning: {}\n", *warning));
  }
}

void show_rays(const RaysRequest& request) {
  const rays::RayChoice kind = rays::parse_ray_choice(request.rays);
  if (!request.file.empty()) {
    if (!rays::is_ray_file(request.file)) {
      throw InputError(fmt::format("'{}' ends neither in {} nor in {}, the extensions of ray files",
                                   request.file, rays::kRayFileEnding, rays::kCsvEnding));
    }
    require_writable(request.file);
  }
  const scenes::Scene scene = open_scene(request.scene);
  const rays::ImageOfRays image = choose_image(scene, request.image);
  const rays::TraceInput input = rays::make_trace_input(scene, image, kind);
  print_facts(request, scene, image, input);
  if (request.file.empty()) return;
  rays::write_ray_file(request.file, as_list(scene, input), note_of(scene, image, input));
}

}  // namespace

void add_rays_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("rays", "Generate a set of rays, describe it and save it");
  const auto request = std::make_shared<RaysRequest>();
  add_scene_option(*command, request->scene);
  command
      ->add_option("--rays", request->rays,
                   "Kind of rays (see 'beambench list') or a .rays or .csv file")
      ->capture_default_str();
  add_image_options(*command, request->image);
  command->add_option("-o", request->file, "File to save the rays to, ending in .rays or .csv");
  command->add_flag("--json", request->json, "Print JSON instead of text");
  command->footer(
      "Coherence is the mean cosine of the angle between the directions of a ray and the next. A\n"
      "saved file can be used in place of a kind of rays, in --rays and in sweeps; it has a\n"
      "line 'beambench-rays 1', a line of JSON, then eight little-endian 32-bit floats per ray:\n"
      "origin, t_min, direction, t_max. The pencils of shadow and mirror rays are in the JSON. A "
      "CSV\n"
      "file has the columns ox,oy,oz,t_min,dx,dy,dz,t_max, and no query: it is read as 'closest'.\n"
      "Examples:\n"
      "  beambench rays escena1 --rays shadow --resolution 320x200\n"
      "  beambench rays balls --rays diffuse:seed=7 -o balls-diffuse.rays\n"
      "  beambench rays tetra --rays random --json");
  command->callback([request] { show_rays(*request); });
}

}  // namespace beambench::cli

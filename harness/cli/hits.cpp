// beambench hits: traces rays through a structure and writes the hits.

#include <cstdio>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/base/messages.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/rays/hit_file.hpp"
#include "harness/rays/trace_results.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::cli {
namespace {

struct HitsRequest {
  std::string scene;
  std::string structure = "sah-bvh";
  std::string rays = "primary";
  ImageRequest image;
  std::string file;
};

void write_hits(const HitsRequest& request) {
  const bool known =
      request.file.ends_with(rays::kHitFileEnding) || request.file.ends_with(rays::kCsvEnding);
  if (!known) {
    throw InputError(fmt::format("'{}' ends neither in {} nor in {}, the extensions of hit files",
                                 request.file, rays::kHitFileEnding, rays::kCsvEnding));
  }
  require_writable(request.file);
  const rays::RayChoice kind = rays::parse_ray_choice(request.rays);
  const accel::StructureChoice choice = choose_one("--accel", request.structure);
  const scenes::Scene scene = open_scene(request.scene);
  const rays::ImageOfRays image = choose_image(scene, request.image);
  const rays::TraceInput input = rays::make_trace_input(scene, image, kind);
  base::Progress progress(1);
  progress.start(fmt::format("{} over {}", choice.short_label(), scene.name));
  const auto structure = choice.build(scene, rays::workload_of(image, input));
  rays::TraceResults results = rays::make_results(input);
  rays::trace_with_progress(*structure, input, results, 1, progress);
  progress.clear();
  rays::write_hit_file(
      request.file, results,
      {{"scene", scene.name}, {"structure", choice.short_label()}, {"rays", input.label()}});
  base::print_message(stderr, fmt::format("{}: {} hits of {} by {}\n", printable(request.file),
                                          input.size(), scene.name, choice.short_label()));
}

}  // namespace

void add_hits_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("hits", "Trace rays with a structure and save the hits");
  const auto request = std::make_shared<HitsRequest>();
  add_scene_option(*command, request->scene);
  command->add_option("--accel", request->structure, "Structure: NAME:parameter=value,...")
      ->capture_default_str();
  command
      ->add_option("--rays", request->rays,
                   "Kind of rays (see 'beambench list') or a .rays or .csv file")
      ->capture_default_str();
  add_image_options(*command, request->image);
  command->add_option("-o", request->file, "File to save the hits to, ending in .hits or .csv")
      ->required();
  command->footer(
      "The hits are the structure's own; 'beambench verify --hits' verifies them. The\n"
      "file has t and primitive of each ray's closest hit, or 0 and 1 for shadow rays. A .hits "
      "file\n"
      "has a line 'beambench-hits 1', a line of JSON, then for each ray the numbers of its\n"
      "'columns', little-endian: t as a float, primitive as a 32-bit integer.\n"
      "Examples:\n"
      "  beambench rays tetera -o tetera.rays\n"
      "  beambench hits tetera --rays tetera.rays --accel embree -o embree.hits\n"
      "  beambench hits balls --resolution 64x48 --accel tile-beam -o balls.csv");
  command->callback([request] { write_hits(*request); });
}

}  // namespace beambench::cli

// beambench sampling: compares the cost and error of methods of choosing the samples of each pixel.

#include "harness/thesis/sampling.hpp"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accel/beam/beam_tracer.hpp"
#include "accel/beam/object_space_sampling.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/text.hpp"
#include "harness/render/picture/image_file.hpp"
#include "harness/render/picture/legend.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/json_text.hpp"

namespace beambench::cli {
namespace {

struct SamplingRequest {
  std::string scene;
  std::string structure = "beam";
  ImageRequest image{"640x480", {}, 1};
  int repetitions = 3;
  std::string picture;
  bool json = false;
};

void print_text(const scenes::Scene& scene, const SamplingRequest& request,
                const std::vector<thesis::SamplingResult>& results) {
  fmt::print("{}: {} primitives, {}, {}\n\n", scene.name, scene.primitives.size(),
             request.structure, request.image.resolution);
  TextTable table({"method", "setting", "rays per pixel", "trace", "error (1)"}, 2);
  for (const thesis::SamplingResult& result : results) {
    table.add({result.method, result.setting, fmt::format("{:.3f}", result.rays),
               fmt::format("{:.4g} ms", result.trace_ms), fmt::format("{:.3f}", result.error)});
  }
  fmt::print("{}\n(1) RMS error on a 0-255 scale, against 64 samples per pixel\n", table.text());
}

void print_json(const scenes::Scene& scene, const SamplingRequest& request,
                const std::vector<thesis::SamplingResult>& results) {
  nlohmann::ordered_json out{{"scene", scene.name},
                             {"primitives", scene.primitives.size()},
                             {"structure", request.structure},
                             {"resolution", request.image.resolution},
                             {"repetitions", request.repetitions},
                             {"results", nlohmann::ordered_json::array()}};
  for (const thesis::SamplingResult& result : results) {
    out["results"].push_back({{"method", result.method},
                              {"setting", result.setting},
                              {"rays_per_pixel", result.rays},
                              {"trace_ms", result.trace_ms},
                              {"error", result.error}});
  }
  fmt::print("{}\n", json_text(out));
}

void write_picture(const std::string& file, const accel::beam::BeamTracer& tracer,
                   const rays::ImageOfRays& image) {
  const accel::PrimaryRays rays(image.camera, image.resolution.width, image.resolution.height,
                                accel::beam::kSampleNumbers.back());
  const accel::beam::SparseSamples samples =
      accel::beam::trace_object_space(tracer, rays, accel::beam::SamplingDensity{});
  const render::HeatMap map{"samples of object-space sampling", rays.width(), rays.height(),
                            thesis::samples_by_pixel(samples)};
  render::write_image(file, render::draw_heat_map_with_legend(map));
}

void compare(const SamplingRequest& request) {
  const accel::StructureChoice choice = choose_one("--accel", request.structure);
  if (!request.picture.empty()) {
    render::image_format(request.picture);
    require_writable(request.picture);
  }
  const scenes::Scene scene = open_scene(request.scene);
  const rays::ImageOfRays image = choose_image(scene, request.image);
  const auto built =
      accel::beam::build_beam_tracer(choice, scene, rays::workload_of(image, image.rays()));
  const accel::beam::BeamTracer& tracer = *built;
  base::Progress progress(thesis::sampling_steps());
  const auto results =
      thesis::compare_sampling(tracer, scene, image, request.repetitions, progress);
  progress.clear();
  request.json ? print_json(scene, request, results) : print_text(scene, request, results);
  if (!request.picture.empty()) write_picture(request.picture, tracer, image);
}

}  // namespace

void add_sampling_command(CLI::App& app, int&) {
  CLI::App* command =
      app.add_subcommand("sampling", "Compare adaptive sampling in object space and image space");
  const auto request = std::make_shared<SamplingRequest>();
  add_scene_option(*command, request->scene);
  command->add_option("--accel", request->structure, "beam, with optional parameters")
      ->capture_default_str();
  command->add_option("--resolution", request->image.resolution, "WxH")->capture_default_str();
  add_view_options(*command, request->image.view);
  command->add_option("--repetitions", request->repetitions, "Number of times each method is timed")
      ->capture_default_str()
      ->check(whole_number_in(1, 1000));
  command->add_option("--picture", request->picture,
                      "PNG of the number of object-space samples in each pixel");
  command->add_flag("--json", request->json, "Print JSON instead of text");
  command->footer(
      "Uniform sampling, as in the thesis (no rays where beams leave the scene); object-space\n"
      "sampling, the thesis's future work: 1, 5 or 25 samples, chosen by the references and\n"
      "the size in pixels of the leaf at which a beam ends; image-space sampling: pixels that\n"
      "differ from their neighbors get more. Errors are relative to 64 samples per pixel, in\n"
      "preview shading.\n"
      "Examples:\n"
      "  beambench sampling delfines --resolution 320x200\n"
      "  beambench sampling maceta --accel beam:max_level=5 --resolution 160x100 --json\n"
      "  beambench sampling escena2 --resolution 320x200 --picture samples.png");
  command->callback([request] { compare(*request); });
}

}  // namespace beambench::cli

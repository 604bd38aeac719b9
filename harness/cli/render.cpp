// beambench render: a picture of what a structure sees, or of the work it does.

#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/text.hpp"
#include "harness/cli/watched_trace.hpp"
#include "harness/cli/work_picture.hpp"
#include "harness/files/pending_file.hpp"
#include "harness/picture/image_file.hpp"
#include "harness/rays/resolution.hpp"
#include "harness/shade/shading.hpp"
#include "scenes/error.hpp"

namespace beambench {
namespace {

struct Request {
  std::string scene;
  std::string structure;
  std::string file;
  std::string resolution;
  std::string camera;
  std::string heatmap;
  std::string shading = "preview";
  int samples = 1;
};

StructureChoice choose_one(const std::string& text) {
  std::vector<StructureChoice> choices = registry().choose_list(text);
  if (choices.size() == 1) return choices.front();
  throw InputError(fmt::format(
      "--accel '{}' names {} structures, but a picture shows one; name one", text, choices.size()));
}

PrimaryRays choose_rays(const Scene& scene, const Request& request) {
  const Camera& camera = choose_camera(scene, request.camera);
  const Resolution resolution = request.resolution.empty() ? Resolution{camera.width, camera.height}
                                                           : parse_resolution(request.resolution);
  const auto samples = sample_offsets(request.samples).size();
  require_ray_count(resolution, static_cast<int>(samples));
  return {camera, resolution.width, resolution.height, request.samples};
}

/// Depth and id of each pixel, those of its nearest sample.
std::vector<DataChannel> hit_channels(const HitBuffer& hits) {
  std::vector<float> depth;
  std::vector<std::uint32_t> id;
  for (std::size_t first = 0; first < hits.size();
       first += static_cast<std::size_t>(hits.samples())) {
    Hit nearest{kInfinity, kNoPrimitive};
    for (std::size_t i = first; i < first + static_cast<std::size_t>(hits.samples()); ++i) {
      if (const auto hit = hits.get(i); hit && precedes(*hit, nearest)) nearest = *hit;
    }
    depth.push_back(nearest.t);
    id.push_back(nearest.primitive);
  }
  std::vector<DataChannel> channels;
  channels.push_back({"Z", std::move(depth)});
  channels.push_back({"id", std::move(id)});
  return channels;
}

/// A PNG gets a legend; an EXR the numbers themselves.
void write_heat_map(const Request& request, const HeatMap& map, const HitBuffer& hits) {
  if (image_format(request.file) == ImageFormat::kPng) {
    write_image(request.file, draw_heat_map_with_legend(map));
    return;
  }
  std::vector<DataChannel> channels = hit_channels(hits);
  channels.push_back({request.heatmap, map.values});
  write_image(request.file, draw_heat_map(map), channels);
}

std::uint64_t count_hits(const HitBuffer& hits) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) count += hits.get(i).has_value();
  return count;
}

void render(const Request& request) {
  const Shading shading = parse_shading(request.shading);
  image_format(request.file);
  require_writable(request.file);
  const StructureChoice choice = choose_one(request.structure);
  const Scene scene = open_scene(request.scene);
  const PrimaryRays rays = choose_rays(scene, request);

  Progress progress(1);
  progress.start(fmt::format("{} over {}", choice.info().name, scene.name));
  const auto accelerator = choice.build(scene);
  HitBuffer hits(rays.width(), rays.height(), rays.samples());
  if (request.heatmap.empty()) {
    watched_trace(*accelerator, rays, hits, progress);
    write_image(request.file, shade(scene, rays, hits, shading), hit_channels(hits));
  } else {
    const HeatMap map = count_work(*accelerator, rays, request.heatmap, hits, progress);
    write_heat_map(request, map, hits);
  }
  progress.say(fmt::format("{}: {} by {}, {}x{}, {} of the rays hit something", request.file,
                           scene.name, short_label(choice), rays.width(), rays.height(),
                           format_share(count_hits(hits), hits.size())));
}

}  // namespace

void add_render_command(CLI::App& app, int&) {
  CLI::App* command =
      app.add_subcommand("render", "A picture of a scene, or of a structure's work");
  const auto request = std::make_shared<Request>();
  command->add_option("SCENE", request->scene, "Catalogue name or path of an NFF file")->required();
  command->add_option("--accel", request->structure, "Structure: NAME:parameter=value,...")
      ->required();
  command->add_option("-o", request->file, "Picture to write, .png or .exr")->required();
  command->add_option("--resolution", request->resolution, "WxH (default: the camera's own)");
  command->add_option("--samples", request->samples, "Rays a pixel: 1, 4, 5, 9, 16, ...")
      ->capture_default_str();
  command->add_option("--shade", request->shading, "preview, normals, id or depth")
      ->capture_default_str();
  command->add_option("--heatmap", request->heatmap,
                      "Instead of shading: a work counter in colours");
  command->add_option("--camera", request->camera, "By name (default: the scene's first)");
  command->footer(
      "Counters for --heatmap: traversal_steps, leaves, empty_leaves, box_tests, primitive_tests,\n"
      "and a structure's own. A .png gets a legend; an .exr holds the counts beside linear float\n"
      "R, G, B, the depth Z and the primitive id (4294967295 for a miss).\n"
      "Examples:\n"
      "  beambench render escena1 --accel samet -o escena1.png\n"
      "  beambench render balls:n=3 --accel samet -o work.png --heatmap primitive_tests\n"
      "  beambench render tetra --accel embree -o tetra.exr --resolution 640x480 --samples 4");
  command->callback([request] { render(*request); });
}

}  // namespace beambench

// beambench trace: one ray's way through a structure, step by step.

#include <charconv>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/ray_way.hpp"
#include "harness/cli/watched_trace.hpp"
#include "harness/differ/judge_ray.hpp"
#include "scenes/error.hpp"

namespace beambench {
namespace {

struct Request {
  std::string scene;
  std::string structure;
  std::string pixel;
  ImageRequest image;
  int sample = 0;
  bool alone = false;
  bool json = false;
};

struct Pixel {
  int x, y;
};

std::optional<int> parse_whole(std::string_view text) {
  int value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

Pixel parse_pixel(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma != std::string_view::npos) {
    const auto x = parse_whole(text.substr(0, comma));
    const auto y = parse_whole(text.substr(comma + 1));
    if (x && y) return {*x, *y};
  }
  throw InputError(fmt::format(
      "pixel '{}' is not X,Y with whole numbers; write it as 10,20, counted from 0,0 at the top "
      "left",
      text));
}

std::size_t sample_index(const Request& request, const PrimaryRays& rays, const HitBuffer& hits) {
  const Pixel pixel = parse_pixel(request.pixel);
  if (pixel.x < 0 || pixel.x >= rays.width() || pixel.y < 0 || pixel.y >= rays.height()) {
    throw InputError(fmt::format(
        "pixel {} is outside of the image; at {}x{} pixels x is 0 to {} and y is 0 to "
        "{}, and --resolution asks for another size",
        request.pixel, rays.width(), rays.height(), rays.width() - 1, rays.height() - 1));
  }
  if (request.sample < 0 || request.sample >= rays.samples()) {
    throw InputError(fmt::format("sample {} does not exist; with --samples {} they are 0 to {}",
                                 request.sample, rays.samples(), rays.samples() - 1));
  }
  return hits.index(pixel.x, pixel.y, request.sample);
}

int trace(const Request& request) {
  parse_pixel(request.pixel);
  const StructureChoice choice = choose_one("--accel", request.structure);
  const Scene scene = open_scene(request.scene);
  const PrimaryRays rays = choose_rays(scene, request.image);
  HitBuffer hits(rays.width(), rays.height(), rays.samples());
  const std::size_t index = sample_index(request, rays, hits);

  const auto accelerator = choice.build(scene);
  const EmbreeOracle oracle(scene, glm::length(glm::dvec3(rays.eye())));
  RayWay way{choice.short_label(), rays.width(), rays.height(), rays.samples(), {}, {}, {}, {}};
  way.in_image = !request.alone;
  const Ray ray = ask_again(rays, hits, index, std::nullopt).ray;
  WorkCounters counters;
  accelerator->closest_hit(ray, counters);
  way.counters = counters.by_name();
  way.steps = accelerator->explain(ray);
  way.alone = accelerator->closest_hit(ray);
  if (request.alone) {
    hits.set(index, way.alone);
  } else {
    Progress progress(1);
    progress.start(fmt::format("{} over {}", choice.info().name, scene.name));
    watched_trace(*accelerator, rays, hits, progress);
  }
  way.judgement = ask_again(rays, hits, index, oracle.closest_hit(ray));
  judge_ray(scene, choice.info().conformance, way.judgement);

  fmt::print("{}", request.json ? to_json(scene, way).dump(2) + '\n' : to_text(scene, way));
  return way.judgement.diff_class == DiffClass::kEngineError ? kFound : kSuccess;
}

}  // namespace

void add_trace_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("trace", "One ray's way through a structure, step by step");
  const auto request = std::make_shared<Request>();
  command->add_option("SCENE", request->scene, "Catalogue name or path of an NFF file")->required();
  command->add_option("--accel", request->structure, "Structure: NAME:parameter=value,...")
      ->required();
  command->add_option("--pixel", request->pixel, "X,Y, counted from 0,0 at the top left")
      ->required();
  add_image_options(*command, request->image);
  command->add_option("--sample", request->sample, "Which of the pixel's samples, from 0")
      ->capture_default_str();
  command->add_flag("--alone", request->alone,
                    "Do not trace the rest of the image: quicker, but packets and beams may answer "
                    "otherwise");
  command->add_flag("--json", request->json, "Print JSON instead of text");
  command->footer(
      "Tells the cells or nodes that the ray enters, in which interval of t, the primitives that\n"
      "are tested there, the hit, and what the oracle says of it, by the classes that 'beambench\n"
      "verify --help' tells. t is view depth. Exits with 1 where the structure is wrong.\n"
      "Examples:\n"
      "  beambench trace escena1 --accel samet --pixel 160,100 --resolution 320x200\n"
      "  beambench trace tetra:n=4 --accel samet:max_level=4 --pixel 256,300 --json\n"
      "  beambench trace balls --accel embree --pixel 8,9 --resolution 64x64 --samples 4 --sample "
      "3");
  command->callback([request, &exit_code] { exit_code = trace(*request); });
}

}  // namespace beambench

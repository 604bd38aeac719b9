// beambench trace: prints the traversal path of one ray, step by step.

#include <charconv>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <glm/vec2.hpp>

#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/verify/ray_path.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/json_text.hpp"

namespace beambench::cli {
namespace {

struct TraceRequest {
  std::string scene;
  std::string structure;
  std::string pixel;
  std::string rays = "primary";
  std::optional<std::size_t> ray;
  std::uint32_t frame = 0;
  ImageRequest image;
  int sample = 0;
  bool alone = false;
  bool json = false;
};

std::optional<int> parse_whole(std::string_view text) {
  int value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

glm::ivec2 parse_pixel(std::string_view text) {
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

std::size_t index_in_image(const TraceRequest& request, const accel::PrimaryRays& rays) {
  if (request.pixel.empty()) {
    throw InputError("a primary ray is identified by its pixel; use --pixel X,Y");
  }
  if (request.ray) throw InputError("a primary ray is identified by --pixel; leave out --ray");
  const glm::ivec2 pixel = parse_pixel(request.pixel);
  if (pixel.x < 0 || pixel.x >= rays.width() || pixel.y < 0 || pixel.y >= rays.height()) {
    throw InputError(fmt::format(
        "pixel {} is outside the image; at {}x{} pixels, x is 0 to {} and y is 0 to {}; "
        "--resolution selects another size",
        request.pixel, rays.width(), rays.height(), rays.width() - 1, rays.height() - 1));
  }
  if (request.sample < 0 || request.sample >= rays.samples()) {
    throw InputError(fmt::format("sample {} does not exist; with --samples {} they are 0 to {}",
                                 request.sample, rays.samples(), rays.samples() - 1));
  }
  const auto at = static_cast<std::size_t>(pixel.y * rays.width() + pixel.x);
  return at * static_cast<std::size_t>(rays.samples()) + static_cast<std::size_t>(request.sample);
}

std::size_t index_in_list(const TraceRequest& request, const rays::TraceInput& input) {
  if (!request.pixel.empty()) {
    throw InputError(
        fmt::format("{} rays are identified by number; use --ray N, as printed with mismatches, "
                    "instead of --pixel",
                    input.label()));
  }
  if (!request.ray || *request.ray >= input.size()) {
    throw InputError(fmt::format("--ray must be a whole number from 0 to {}: there are {} {} rays",
                                 input.size() - 1, input.size(), input.label()));
  }
  return *request.ray;
}

int trace(const TraceRequest& request) {
  if (!request.pixel.empty()) parse_pixel(request.pixel);
  const rays::RayChoice kind = rays::parse_ray_choice(request.rays);
  const accel::StructureChoice choice = choose_one("--accel", request.structure);
  const scenes::Scene scene = open_scene(request.scene, request.frame);
  const rays::ImageOfRays image = choose_image(scene, request.image);
  const rays::TraceInput input = rays::make_trace_input(scene, image, kind);
  const std::size_t index = input.image() != nullptr ? index_in_image(request, *input.image())
                                                     : index_in_list(request, input);
  base::Progress progress(1);
  const verify::RayPath path =
      verify::trace_path(choice, scene, image, input, index, request.alone, progress);
  progress.clear();
  fmt::print("{}", request.json ? json_text(to_json(scene, path)) + '\n' : to_text(scene, path));
  return path.verified.diff_class == verify::DiffClass::kStructureError ? base::kMismatch
                                                                        : base::kSuccess;
}

}  // namespace

void add_trace_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("trace", "Print the traversal path of one ray, step by step");
  const auto request = std::make_shared<TraceRequest>();
  add_scene_option(*command, request->scene);
  add_frame_option(*command, request->frame);
  command->add_option("--accel", request->structure, "Structure: NAME:parameter=value,...")
      ->required();
  command->add_option("--pixel", request->pixel,
                      "Pixel of the primary ray: X,Y, counted from 0,0 at the top left");
  add_image_options(*command, request->image);
  command->add_option("--sample", request->sample, "Index of the pixel's sample, starting at 0")
      ->capture_default_str();
  command
      ->add_option("--rays", request->rays, "Kind of rays (see 'beambench list') or a .rays file")
      ->capture_default_str();
  command->add_option("--ray", request->ray,
                      "Index of the ray, if it is not primary, starting at 0");
  command->add_flag("--alone", request->alone,
                    "Trace no other rays: faster, but packets and beams may find a different hit");
  command->add_flag("--json", request->json, "Print JSON instead of text");
  command->footer(
      "Prints the cells or nodes that the ray enters, the interval of t in each, the primitives\n"
      "tested there, the hit, and how it compares with the oracle's, in the classes of 'beambench\n"
      "verify --help'. For primary rays t is view depth. For shadow rays the path to the closest\n"
      "hit is printed, though any hit would do. Exits with 1 if the structure is wrong.\n"
      "With --accel beam, a primary ray is traced with its image: the beams that contain the\n"
      "sample are printed, from the first to the one it ends in, each with its leaf, the planes\n"
      "that cut it, its outline in pixels and its number of samples; then the sample's own tests.\n"
      "--alone traces the ray without beams, by Samet's traversal.\n"
      "Examples:\n"
      "  beambench trace delfines --accel beam --pixel 30,30 --resolution 64x64\n"
      "  beambench trace escena1 --accel samet --pixel 160,100 --resolution 320x200\n"
      "  beambench trace tetra:n=4 --accel samet:max_level=4 --pixel 256,300 --json\n"
      "  beambench trace balls --accel embree --pixel 8,9 --resolution 64x64 --samples 4 --sample "
      "3\n"
      "  beambench trace escena1 --accel samet --rays shadow --ray 100 --resolution 64x64");
  command->callback([request, &exit_code] { exit_code = trace(*request); });
}

}  // namespace beambench::cli

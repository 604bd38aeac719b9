// beambench scene: prints the contents of a scene, or its primitives and memory at growing sizes.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "harness/cli/commands.hpp"
#include "harness/cli/inputs.hpp"
#include "harness/cli/text.hpp"
#include "harness/measure/scene_growth.hpp"
#include "harness/rays/fingerprint.hpp"
#include "scenes/base/json_text.hpp"

namespace beambench::cli {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const glm::vec3& v) { return Json::array({v.x, v.y, v.z}); }

std::string to_text(const glm::vec3& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

std::size_t smooth_polygons(const scenes::Scene& scene) {
  std::size_t count = 0;
  for (const scenes::Polygon& polygon : scene.polygons)
    count += polygon.first_normal != scenes::Polygon::kFlat;
  return count;
}

/// Returns the words of the finishes in use, in the order of the surfaces.
std::vector<std::string_view> finishes_of(const scenes::Scene& scene) {
  std::vector<std::string_view> words;
  for (const scenes::Surface& surface : scene.surfaces) {
    const std::string_view word = scenes::finish_word(surface.finish);
    const bool seen = std::find(words.begin(), words.end(), word) != words.end();
    if (surface.finish != scenes::Finish::kPlain && !seen) words.push_back(word);
  }
  return words;
}

/// An animated scene, at one of its frames.
struct Shown {
  scenes::Scene scene;
  std::uint32_t frame;
  std::uint32_t frames;
};

void print_text(const Shown& shown) {
  const scenes::Scene& scene = shown.scene;
  const auto line = [](std::string_view name, const std::string& value) {
    fmt::print("  {:<12}  {}\n", name, value);
  };
  fmt::print("{}\n", scene.name);
  line("primitives", fmt::format("{}: {} spheres, {} cones, {} polygons ({} of them smooth)",
                                 scene.primitives.size(), scene.spheres.size(), scene.cones.size(),
                                 scene.polygons.size(), smooth_polygons(scene)));
  line("triangles",
       fmt::format("{} over {} vertices", scene.triangles.size(), scene.vertices.size()));
  if (shown.frames > 1) {
    line("frames", fmt::format("{}; this is frame {}", shown.frames, shown.frame));
  }
  line("bounds", scene.bounds.empty() ? "none"
                                      : fmt::format("{} to {}", to_text(scene.bounds.lower),
                                                    to_text(scene.bounds.upper)));
  for (const scenes::Camera& camera : scene.cameras) {
    line("camera", fmt::format("{}: from {} at {} up {}, angle {:.4g}, {}x{}", camera.name,
                               to_text(camera.from), to_text(camera.at), to_text(camera.up),
                               camera.angle, camera.width, camera.height));
  }
  for (const scenes::Light& light : scene.lights) {
    line("light", fmt::format("at {}, color {}", to_text(light.position), to_text(light.color)));
  }
  const std::vector<std::string_view> finishes = finishes_of(scene);
  line("surfaces", fmt::format("{}{}{}", scene.surfaces.size(), finishes.empty() ? "" : ", with ",
                               fmt::join(finishes, ", ")));
  line("background", to_text(scene.background));
  line("hash", rays::hex_digits(scenes::scene_hash(scene)));
}

Json camera_json(const scenes::Camera& camera) {
  return {{"name", camera.name},      {"from", to_json(camera.from)}, {"at", to_json(camera.at)},
          {"up", to_json(camera.up)}, {"angle", camera.angle},        {"aspect", camera.aspect},
          {"width", camera.width},    {"height", camera.height}};
}

void print_json(const Shown& shown) {
  const scenes::Scene& scene = shown.scene;
  Json out{{"name", scene.name},
           {"primitives", scene.primitives.size()},
           {"spheres", scene.spheres.size()},
           {"cones", scene.cones.size()},
           {"polygons", scene.polygons.size()},
           {"smooth_polygons", smooth_polygons(scene)},
           {"triangles", scene.triangles.size()},
           {"vertices", scene.vertices.size()},
           {"frames", shown.frames},
           {"frame", shown.frame},
           {"bounds", nullptr},
           {"cameras", Json::array()},
           {"lights", Json::array()},
           {"surfaces", scene.surfaces.size()},
           {"finishes", finishes_of(scene)},
           {"background", to_json(scene.background)},
           {"hash", rays::hex_digits(scenes::scene_hash(scene))}};
  if (!scene.bounds.empty()) {
    out["bounds"] = {{"lower", to_json(scene.bounds.lower)},
                     {"upper", to_json(scene.bounds.upper)}};
  }
  for (const scenes::Camera& camera : scene.cameras) out["cameras"].push_back(camera_json(camera));
  for (const scenes::Light& light : scene.lights) {
    out["lights"].push_back(
        {{"position", to_json(light.position)}, {"color", to_json(light.color)}});
  }
  fmt::print("{}\n", json_text(out));
}

void print_text(const measure::SceneGrowth& growth) {
  TextTable table({growth.size_parameter, "primitives", "memory", "per primitive", "seconds"}, 0);
  for (const measure::GrownScene& row : growth.sizes) {
    const double each = static_cast<double>(row.bytes) / static_cast<double>(row.primitives);
    table.add({fmt::format("{}", row.size), fmt::format("{}", row.primitives),
               format_bytes(row.bytes), fmt::format("{:.0f} bytes", each),
               fmt::format("{:.4f}", row.seconds)});
  }
  fmt::print("{}\n{}", growth.generator, table.text());
}

void print_json(const measure::SceneGrowth& growth) {
  nlohmann::ordered_json out{{"scene", growth.generator},
                             {"size_parameter", growth.size_parameter}};
  for (const measure::GrownScene& row : growth.sizes) {
    out["sizes"].push_back({{"scene", row.scene},
                            {"size", row.size},
                            {"primitives", row.primitives},
                            {"bytes", row.bytes},
                            {"seconds", row.seconds}});
  }
  fmt::print("{}\n", json_text(out));
}

/// Prints CSV; labels are quoted because they may contain commas.
void print_csv(const measure::SceneGrowth& growth) {
  fmt::print("generator,parameter,size,primitives,bytes,seconds,scene\n");
  for (const measure::GrownScene& row : growth.sizes) {
    fmt::print("{},{},{},{},{},{:.6f},\"{}\"\n", growth.generator, growth.size_parameter, row.size,
               row.primitives, row.bytes, row.seconds, row.scene);
  }
}

struct SceneRequest {
  std::string scene;
  bool json = false;
  bool csv = false;
  bool growth = false;
  std::size_t growth_limit = 1000000;
  std::uint32_t frame = 0;
  scenes::ReadOptions options;
};

void show(const SceneRequest& request) {
  if (request.growth) {
    base::Progress progress(1);
    const auto growth = measure::measure_growth(request.scene, request.growth_limit, progress);
    progress.clear();
    request.csv ? print_csv(growth) : request.json ? print_json(growth) : print_text(growth);
    return;
  }
  scenes::Animation animation = open_animation(request.scene, request.options);
  if (request.frame > 0) scenes::show_frame(animation, request.frame);
  const Shown shown{std::move(animation.scene), request.frame, animation.frames};
  request.json ? print_json(shown) : print_text(shown);
}

}  // namespace

void add_scene_command(CLI::App& app, int&) {
  CLI::App* command =
      app.add_subcommand("scene", "Print a scene's counts, bounds, cameras and hash");
  const auto request = std::make_shared<SceneRequest>();
  add_scene_option(*command, request->scene);
  CLI::Option* json = command->add_flag("--json", request->json, "Print JSON instead of text");
  command->add_flag("--strict", request->options.strict,
                    "Reject a file with unknown words, ignored fields, degenerate primitives or "
                    "polygons to repair");
  CLI::Option* frame = add_frame_option(*command, request->frame);
  CLI::Option* growth = command->add_flag(
      "--growth", request->growth,
      "Generate the scene in growing sizes; print primitives, bytes and seconds for each");
  growth->excludes(frame);
  command->add_option("--growth-limit", request->growth_limit, "Maximum number of primitives")
      ->check(whole_number_in(1, measure::kMaxGrowth))
      ->capture_default_str()
      ->needs(growth);
  command->add_flag("--csv", request->csv, "Print the growth as CSV")
      ->needs(growth)
      ->excludes(json);
  command->footer(
      "Bytes are those of the scene's arrays, including spare capacity; seconds are wall time.\n"
      "Examples:\n"
      "  beambench scene escena1\n"
      "  beambench scene balls:n=3 --json\n"
      "  beambench scene waving-sheet --frame 7\n"
      "  beambench scene tetra --growth --growth-limit 10000000 --csv > tetra.csv");
  command->callback([request] { show(*request); });
}

}  // namespace beambench::cli

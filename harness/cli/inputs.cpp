#include "harness/cli/inputs.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "harness/rays/ray_kind.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::cli {
namespace {

/// Parses a vector; `option` names the value in messages.
glm::vec3 parse_vector(std::string_view option, std::string_view text) {
  std::array<float, 3> numbers{};
  std::string_view rest = text;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const bool last = i + 1 == numbers.size();
    const std::size_t end = last ? rest.size() : rest.find(',');
    if (end == std::string_view::npos) break;
    const char* const stop = rest.data() + end;
    const auto [at, error] = std::from_chars(rest.data(), stop, numbers[i]);
    if (error != std::errc() || at != stop || !(std::abs(numbers[i]) <= scenes::kLargestNumber))
      break;
    if (last) return {numbers[0], numbers[1], numbers[2]};
    rest.remove_prefix(end + 1);
  }
  throw InputError(
      fmt::format("{} '{}' is not X,Y,Z with three numbers up to {:g}; write it as 1,2.5,-3",
                  option, text, scenes::kLargestNumber));
}

void require_view(const scenes::Camera& camera) {
  const glm::dvec3 view = glm::dvec3(camera.at) - glm::dvec3(camera.from);
  if (glm::length(view) == 0.0) {
    throw InputError("--from and --at are the same point; choose different points");
  }
  const glm::dvec3 up(camera.up);
  if (glm::length(up) == 0.0 ||
      glm::length(glm::cross(glm::normalize(view), glm::normalize(up))) < 1e-6) {
    throw InputError(
        "the view direction is parallel to the up direction; choose another with --up, such as "
        "0,0,1");
  }
}

}  // namespace

void add_scene_option(CLI::App& command, std::string& scene) {
  command.add_option("SCENE", scene, kSceneHelp)->required();
}

CLI::Option* add_frame_option(CLI::App& command, std::uint32_t& frame) {
  return command.add_option("--frame", frame, "Frame of an animated scene, starting at 0")
      ->type_name("K")
      ->capture_default_str();
}

void add_camera_option(CLI::App& command, ViewRequest& request) {
  command.add_option("--camera", request.camera, "Name of the camera (default: the scene's first)");
}

void add_view_options(CLI::App& command, ViewRequest& request) {
  add_camera_option(command, request);
  const auto add = [&](const char* name, std::string& value, const char* help) {
    command.add_option(name, value, help)->type_name("X,Y,Z");
  };
  add("--from", request.from, "Eye point, instead of the camera's");
  add("--at", request.at, "Point that the camera looks at");
  add("--up", request.up, "Up direction in the image");
  command
      .add_option("--angle", request.angle,
                  "Vertical field of view in degrees, more than 0 and less than 180")
      ->type_name("DEGREES");
}

scenes::Camera choose_camera(const scenes::Scene& scene, const ViewRequest& request) {
  scenes::Camera camera =
      request.camera.empty() ? scene.cameras.front() : scenes::find_camera(scene, request.camera);
  if (request.from.empty() && request.at.empty() && request.up.empty() && !request.angle) {
    return camera;
  }
  camera.name = kTypedCamera;
  if (!request.from.empty()) camera.from = parse_vector("--from", request.from);
  if (!request.at.empty()) camera.at = parse_vector("--at", request.at);
  if (!request.up.empty()) camera.up = parse_vector("--up", request.up);
  if (request.angle) {
    if (!(*request.angle > 0.0 && *request.angle < 180.0)) {
      throw InputError(fmt::format(
          "--angle {} is not a field of view; expected more than 0 and less than 180 degrees",
          *request.angle));
    }
    camera.angle = static_cast<float>(*request.angle);
  }
  require_view(camera);
  return camera;
}

void add_verbose_option(CLI::App& command, bool& verbose) {
  command.add_flag("--verbose", verbose,
                   "Print a line for each cell even on a terminal, instead of one progress line");
}

void add_timeout_option(CLI::App& command, double& seconds) {
  command
      .add_option("--timeout", seconds,
                  "Seconds within which the shared object of a plug-in must build a structure "
                  "over a scene and finish all queries; otherwise the case fails")
      ->check(number_in(0.1, 86400.0))
      ->capture_default_str();
}

CLI::Validator whole_number_in(std::int64_t lower, std::int64_t upper) {
  const std::string range = fmt::format("a whole number from {} to {}", lower, upper);
  return {[=](const std::string& text) {
            std::int64_t number = 0;
            const char* const stop = text.data() + text.size();
            const auto [end, error] = std::from_chars(text.data(), stop, number);
            const bool valid = error == std::errc() && end == stop && number >= lower;
            return valid && number <= upper ? "" : fmt::format("'{}' is not {}", text, range);
          },
          fmt::format("in [{} - {}]", lower, upper)};
}

CLI::Validator number_in(double lower, double upper) {
  const std::string range = fmt::format("a number from {} to {}", lower, upper);
  return {[=](const std::string& text) {
            double number = 0.0;
            const char* const stop = text.data() + text.size();
            const auto [end, error] = std::from_chars(text.data(), stop, number);
            const bool valid = error == std::errc() && end == stop && number >= lower;
            return valid && number <= upper
                       ? ""
                       : fmt::format("'{}' is not {}, written without a unit", text, range);
          },
          fmt::format("in [{} - {}]", lower, upper)};
}

void refuse_structures_as_scenes(const std::vector<std::string>& scenes) {
  const auto refuse = [](std::string_view name, std::string_view what, std::string_view option) {
    throw InputError(fmt::format(
        "'{}' is {}, not a scene; a list after {} is separated by commas, without blanks: {} A,B",
        name, what, option, option));
  };
  for (const std::string& scene : scenes) {
    const std::string_view name = std::string_view(scene).substr(0, scene.find_first_of(":,"));
    const auto is_name = [&](const auto& info) { return info.name == name; };
    if (std::ranges::any_of(scenes::scene_catalogue(), is_name)) continue;
    if (std::ranges::any_of(accel::registry().structures(), is_name)) {
      refuse(name, "a structure", "--accel");
    }
    if (std::ranges::any_of(rays::ray_kinds(), is_name)) refuse(name, "a kind of rays", "--rays");
  }
}

accel::StructureChoice choose_one(std::string_view option, std::string_view text) {
  std::vector<accel::StructureChoice> choices = accel::registry().choose_list(text);
  if (choices.size() == 1) return choices.front();
  throw InputError(
      fmt::format("{} '{}' names {} structures; name one", option, text, choices.size()));
}

rays::ImageOfRays choose_image(const scenes::Scene& scene, const ImageRequest& request) {
  const scenes::Camera camera = choose_camera(scene, request.view);
  return rays::image_of(camera, chosen_resolution(request), request.samples);
}

std::optional<rays::Resolution> chosen_resolution(const ImageRequest& request) {
  if (request.resolution.empty()) return std::nullopt;
  return rays::parse_resolution(request.resolution);
}

void add_size_options(CLI::App& command, ImageRequest& request) {
  command.add_option("--resolution", request.resolution, "WxH (default: the camera's own)");
  command.add_option("--samples", request.samples, "Rays per pixel: 1, 4, 5, 9, 16, ...")
      ->capture_default_str();
}

void add_image_options(CLI::App& command, ImageRequest& request) {
  add_size_options(command, request);
  add_view_options(command, request.view);
}

Contenders choose_contenders(std::string_view list, const scenes::Scene& scene) {
  Contenders contenders;
  const std::vector<Spec> specs = parse_spec_list(list);
  const auto named = [&](std::string_view name) {
    return std::any_of(specs.begin(), specs.end(),
                       [&](const Spec& spec) { return spec.name == name; });
  };
  contenders.choices = accel::registry().choose_list(list);
  const bool too_many = scene.primitives.size() > kExhaustiveLimit;
  if (too_many && named("all") && !named("exhaustive")) {
    std::erase_if(contenders.choices, [](const accel::StructureChoice& choice) {
      return choice.info().name == "exhaustive";
    });
    contenders.note = fmt::format(
        "{}: exhaustive is left out of 'all' above {} primitives (the scene has {}); name it in "
        "--accel to include it",
        scene.name, kExhaustiveLimit, scene.primitives.size());
  }
  return contenders;
}

void add_light_options(CLI::App& command, WhittedRequest& request) {
  command
      .add_option("--depth", request.max_depth,
                  "Maximum ray depth, including the primary ray; 1: no mirrors and no glass")
      ->capture_default_str()
      ->check(whole_number_in(1, 64));
  command
      .add_option("--shadows", request.shadows,
                  "rays; cache: test the last occluder first; light-buffer: lists of occluders, "
                  "made in advance for each direction from a light")
      ->capture_default_str();
  command
      .add_option("--min-weight", request.min_weight,
                  "Trace a reflected or refracted ray only if it contributes at least this much to "
                  "its pixel; 0: trace all")
      ->capture_default_str()
      ->check(number_in(0.0, 1.0));
}

void add_whitted_options(CLI::App& command, WhittedRequest& request) {
  add_light_options(command, request);
  command
      .add_option("--threads", request.threads,
                  "Number of threads; 0: one per core, within the CPU quota")
      ->capture_default_str()
      ->check(whole_number_in(0, 1024));
}

render::WhittedOptions whitted_options(const WhittedRequest& request) {
  return {request.max_depth, request.min_weight, render::parse_shadow_method(request.shadows)};
}

std::string file_stem(std::string title) {
  for (char& c : title) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '.') c = '-';
  }
  return title;
}

std::string picture_name(std::string title) { return file_stem(std::move(title)) + ".png"; }

void replace_renamed_options(std::string_view program, std::vector<std::string>& arguments) {
  constexpr std::array<std::array<std::string_view, 2>, 1> kRenamed{{
      {"--least-weight", "--min-weight"},
  }};
  for (std::string& argument : arguments) {
    for (const auto& [old_name, new_name] : kRenamed) {
      if (argument != old_name && !argument.starts_with(fmt::format("{}=", old_name))) continue;
      base::report_error(program, fmt::format("{} is now called {}", old_name, new_name), 0);
      argument.replace(0, old_name.size(), new_name);
    }
  }
}

}  // namespace beambench::cli

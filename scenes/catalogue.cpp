#include "scenes/catalogue.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scenes/base/error.hpp"
#include "scenes/base/nearest_name.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/perturbed.hpp"

namespace beambench::scenes {

// Defined by the build from its lists of formats and scenes (register_scenes.cpp.in).
void register_scenes(Catalogue& catalogue);

namespace {

Catalogue& whole_catalogue() {
  static Catalogue all = [] {
    Catalogue built;
    register_scenes(built);
    return built;
  }();
  return all;
}

bool has_ending(std::string_view file_name, std::string_view ending) {
  std::string name(file_name);
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name.ends_with(ending);
}

/// Returns a plug-in's reader as a format.
SceneFormat format_of(const SceneReader& reader) {
  return {[ending = reader.ending](std::string_view spec) { return has_ending(spec, ending); },
          [read = reader.read](std::string_view spec, ReadOptions options,
                               std::vector<std::string>& warnings) {
            Scene scene = read(std::filesystem::path(spec), warnings);
            if (options.strict && !warnings.empty()) throw InputError(warnings.front());
            return Animation{std::move(scene)};
          }};
}

const SceneFormat* find_format(std::string_view spec) {
  const auto formats = whole_catalogue().formats();
  const auto found =
      std::ranges::find_if(formats, [&](const SceneFormat& format) { return format.reads(spec); });
  return found == formats.end() ? nullptr : &*found;
}

/// Throws InputError for a scene without primitives, on which every structure would agree and a
/// comparison would be meaningless. For a file, the first warning explains why primitives were
/// skipped.
void require_primitives(const Scene& scene, const std::vector<std::string>& noticed) {
  if (!scene.primitives.empty()) return;
  throw InputError(
      fmt::format("{}: the scene has no primitives{}; give it at least one sphere, cone or polygon",
                  scene.name, noticed.empty() ? "" : fmt::format(" ({})", noticed.front())));
}

[[noreturn]] void refuse_name(const std::string& name) {
  std::vector<std::string> names;
  for (const SceneInfo& info : scene_catalogue()) names.push_back(info.name);
  throw InputError(fmt::format(
      "there is no scene '{}'; {}the scenes are {}; a file is given as a path with the ending "
      ".nff, the ending of a mesh format, or no ending, and an installed mesh as mesh:NAME; scenes "
      "of a plug-in need --plugin FILE",
      excerpt(name), did_you_mean(name, names), fmt::join(names, ", ")));
}

/// Removes the parameter `perturb`, common to all catalogue scenes, from the given ones and returns
/// its value, which is 0 if the scene is not perturbed. Otherwise, if the scene has its own seed
/// and none was given, also changes that seed.
std::uint64_t take_perturbation(Spec& spec, const SceneInfo& info) {
  const ParameterInfo& perturb = perturb_parameter();
  const auto find_given = [&](std::string_view name) {
    return std::ranges::find(spec.parameters, name, [](const auto& pair) { return pair.first; });
  };
  const auto given = find_given(perturb.name);
  if (given == spec.parameters.end()) return 0;
  const Parameters own(info.name, std::span(&perturb, 1), std::span(&*given, 1));
  const auto number = static_cast<std::uint64_t>(own.integer(perturb.name));
  spec.parameters.erase(given);
  const auto seed = std::ranges::find(info.parameters, "seed", &ParameterInfo::name);
  const bool is_given = find_given("seed") != spec.parameters.end();
  if (number > 0 && seed != info.parameters.end() && !is_given) {
    spec.parameters.emplace_back("seed", std::to_string(std::stoull(seed->default_value) + number));
  }
  return number;
}

}  // namespace

const ParameterInfo& perturb_parameter() {
  static const ParameterInfo info = integer_parameter(
      "perturb", 0, 0, 1'000'000,
      "common to all these scenes: places the objects and the camera differently, by this seed");
  return info;
}

ParameterInfo frames_parameter() {
  return integer_parameter("frames", 20, 2, 10'000, "number of frames");
}

void Catalogue::add(SceneInfo scene) {
  if (!scene.generate && scene.animate) {
    scene.generate = [animate = scene.animate](const Parameters& parameters) {
      return animate(parameters).scene;
    };
  }
  const auto place = std::ranges::upper_bound(scenes_, scene.name, {}, &SceneInfo::name);
  scenes_.insert(place, std::move(scene));
}

void Catalogue::add_format(SceneFormat format) { formats_.push_back(std::move(format)); }

void Catalogue::add_reader(SceneReader reader) {
  formats_.insert(formats_.begin(), format_of(reader));
  readers_.push_back(std::move(reader));
}

std::span<const SceneInfo> scene_catalogue() { return whole_catalogue().scenes(); }

std::span<const SceneReader> scene_readers() { return whole_catalogue().readers(); }

void register_plugin_scenes(std::vector<SceneInfo> scenes, std::vector<SceneReader> readers) {
  for (SceneInfo& scene : scenes) whole_catalogue().add(std::move(scene));
  for (SceneReader& reader : readers) whole_catalogue().add_reader(std::move(reader));
}

const SceneInfo& find_scene(const std::string& name) {
  const auto catalogue = scene_catalogue();
  const auto info = std::ranges::find(catalogue, name, &SceneInfo::name);
  if (info == catalogue.end()) refuse_name(name);
  return *info;
}

bool is_scene_file(std::string_view spec) {
  return find_format(divide_frame(spec).scene) != nullptr;
}

Scene load_scene(std::string_view spec, std::vector<std::string>* warnings, ReadOptions options) {
  return load_animation(spec, warnings, options).scene;
}

namespace {

/// Loads the scene, with its frames, in frame 0.
Animation load_first_frame(std::string_view spec, std::vector<std::string>* warnings,
                           ReadOptions options) {
  if (const SceneFormat* format = find_format(spec)) {
    std::vector<std::string> noticed;
    Animation animation = format->read(spec, options, noticed);
    animation.scene.name = name_of_path(spec);
    require_primitives(animation.scene, noticed);
    if (warnings != nullptr)
      std::ranges::transform(noticed, std::back_inserter(*warnings), message_line);
    return animation;
  }
  Spec parsed = parse_spec(spec);
  const SceneInfo& info = find_scene(parsed.name);
  const std::uint64_t seed = take_perturbation(parsed, info);
  const Parameters parameters(info.name, info.parameters, parsed.parameters);
  Animation animation =
      info.animate ? info.animate(parameters) : Animation{info.generate(parameters)};
  parameters.require_given_were_read();
  Scene& scene = animation.scene;
  if (!info.origin.empty()) scene.name = parameters.label();  // records and replays rely on it
  require_primitives(scene, {});
  if (seed == 0) return animation;
  scene.name += fmt::format("{}{}={}", scene.name.find(':') == std::string::npos ? ':' : ',',
                            perturb_parameter().name, seed);
  return {perturbed(scene, seed)};  // static, because objects are identified by their positions
}

}  // namespace

Animation load_animation(std::string_view spec, std::vector<std::string>* warnings,
                         ReadOptions options) {
  const FrameName name = divide_frame(spec);
  if (!name.frame || std::filesystem::exists(spec)) {
    return load_first_frame(spec, warnings, options);
  }
  Animation animation = load_first_frame(name.scene, warnings, options);
  show_frame(animation, *name.frame);
  animation.scene.name += fmt::format("@{}", *name.frame);
  return animation;
}

}  // namespace beambench::scenes

#include "harness/measure/config.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "accel/core/primary_rays.hpp"
#include "harness/measure/find_sweep.hpp"
#include "harness/measure/json_node.hpp"
#include "scenes/base/json_text.hpp"

namespace beambench::measure {
namespace {

/// The maximum number of cells, more than any run could measure: with six repetitions of a
/// millisecond each, ten minutes.
constexpr double kMaxCells = 100'000;

/// Returns the length of a list; 1 for any other value.
double length(const nlohmann::json& value) {
  return value.is_array() ? static_cast<double>(value.size()) : 1.0;
}

/// Returns the same for a member; 1 where there is none.
double length_of(const nlohmann::json& object, const char* key) {
  return object.is_object() && object.contains(key) ? length(object[key]) : 1.0;
}

/// Returns the combinations of the lists of parameters of one entry.
double combinations(const nlohmann::json& entry) {
  double product = 1.0;
  if (!entry.is_object() || !entry.contains("parameters")) return product;
  const nlohmann::json& parameters = entry["parameters"];
  if (!parameters.is_object()) return product;  // items() of a list are its elements
  for (const auto& [name, values] : parameters.items()) product *= length(values);
  return product;
}

/// Returns the sum over the entries of a list; 1 where there is none.
template <class Count>
double sum_of(const nlohmann::json& root, const char* key, Count count) {
  if (!root.is_object() || !root.contains(key) || !root[key].is_array()) return 1.0;
  double sum = 0.0;
  for (const nlohmann::json& entry : root[key]) sum += count(entry);
  return sum;
}

/// Returns the number of structures that the document lists, before any is made. A text counts
/// once, even `all`.
double listed_structures(const JsonNode& root) {
  return sum_of(root.value(), "structures", combinations);
}

/// Refuses a sweep whose lists multiply to too many cells. Ignores mistakes in the lists, which are
/// found when they are read.
void require_affordable(const JsonNode& root, double structures) {
  const nlohmann::json& json = root.value();
  const double views =
      sum_of(json, "scenes", [](const auto& entry) { return length_of(entry, "cameras"); });
  const double resolutions = length_of(json, "resolutions");
  const double samples = length_of(json, "samples");
  const double rays = length_of(json, "rays");
  const double cells = views * structures * resolutions * samples * rays;
  if (cells <= kMaxCells) return;
  root.fail(fmt::format(
      "its lists multiply to {:.0f} cells ({:.0f} cameras of scenes x {:.0f} structures x {:.0f} "
      "resolutions x {:.0f} samples x {:.0f} kinds of rays), more than {:.0f}; shorten them, or "
      "divide the sweep into several",
      cells, views, structures, resolutions, samples, rays, kMaxCells));
}

/// A parameter and the values it takes in turn.
struct SweptParameter {
  std::string name;
  std::vector<std::string> values;
};

SweptParameter read_parameter(const std::string& structure, const std::string& name,
                              const JsonNode& node, const accel::Registry& structures) {
  const std::vector<JsonNode> nodes =
      node.value().is_array() ? node.elements() : std::vector<JsonNode>{node};
  SweptParameter parameter{name, {}};
  for (const JsonNode& value : nodes) {
    const std::string text = value.parameter_text();
    // Chosen alone for the sake of the message: parameters are checked independently.
    value.checked([&] { return structures.choose({structure, {{name, text}}}); });
    parameter.values.push_back(text);
  }
  return parameter;
}

/// Returns all combinations, as specs of `structure`.
std::vector<Spec> multiply_out(const std::string& structure,
                               const std::vector<SweptParameter>& parameters) {
  std::vector<Spec> specs{{structure, {}}};
  for (const SweptParameter& parameter : parameters) {
    std::vector<Spec> longer;
    for (const Spec& spec : specs) {
      for (const std::string& value : parameter.values) {
        longer.push_back(spec);
        longer.back().parameters.emplace_back(parameter.name, value);
      }
    }
    specs = std::move(longer);
  }
  return specs;
}

/// Returns the structures that an entry stands for: a text as after `--accel` ("samet:max_level=6",
/// "all"), or an object {"structure": name, "parameters": {name: value or list of values}} whose
/// lists are multiplied out, the alphabetically last parameter varying fastest.
std::vector<accel::StructureChoice> read_structure_entry(const JsonNode& node,
                                                         const accel::Registry& structures) {
  if (node.value().is_string()) {
    const std::string text = node.text();
    return node.checked([&] { return structures.choose_list(text); });
  }
  node.require_object({"structure", "parameters"});
  const JsonNode name_node = node.require("structure");
  const std::string name = name_node.text();
  name_node.checked([&] { return structures.choose({name, {}}); });
  std::vector<SweptParameter> parameters;
  if (const auto given = node.find("parameters")) {
    for (const auto& [key, value] : given->members()) {
      parameters.push_back(read_parameter(name, key, value, structures));
    }
  }
  std::vector<accel::StructureChoice> choices;
  for (const Spec& spec : multiply_out(name, parameters))
    choices.push_back(structures.choose(spec));
  return choices;
}

constexpr double kDefaultPrecision = 0.02;
constexpr double kDefaultWarmUp = 0.5;  // seconds
constexpr double kMaxWarmUp = 60.0;
constexpr std::int64_t kMaxRepetitions = 100'000;
constexpr std::int64_t kMaxThreads = 1024;
constexpr double kMaxBudgetSeconds = 1e7;  // some four months

/// The name ends up in run ids and folder names.
std::string read_name(const JsonNode& node) {
  constexpr std::size_t kMaxLength = 64;
  std::string name = node.text();
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  const auto is_allowed = [&](char c) { return is_plain(c) || c == '.' || c == '_' || c == '-'; };
  if (name.empty() || name.size() > kMaxLength || !is_plain(name.front()) ||
      !std::all_of(name.begin(), name.end(), is_allowed)) {
    node.fail(
        fmt::format("expected 1 to {} of the letters A-Z, a-z, 0-9, '.', '_', '-', the first "
                    "one a letter or digit",
                    kMaxLength));
  }
  return name;
}

SceneEntry read_scene(const JsonNode& node) {
  if (node.value().is_string()) return {node.text(), {}, node.place()};
  node.require_object({"scene", "cameras"});
  SceneEntry entry{node.require("scene").text(), {}, node.place()};
  if (const auto cameras = node.find("cameras")) {
    for (const JsonNode& camera : cameras->elements()) entry.cameras.push_back(camera.text());
  }
  return entry;
}

int read_samples(const JsonNode& node) {
  const int samples = static_cast<int>(node.integer(1, 4096));
  node.checked([&] { return accel::sample_offsets(samples); });
  return samples;
}

Exclusion read_exclusion(const JsonNode& node, const accel::Registry& structures) {
  node.require_object({"structure", "scene", "primitives_above", "rays_above"});
  if (node.members().empty())
    node.fail("expected at least one condition; this excludes everything");
  Exclusion exclusion;
  if (const auto structure = node.find("structure")) {
    const std::string name = structure->text();
    structure->checked([&] { return structures.choose({name, {}}); });
    exclusion.structure = name;
  }
  if (const auto scene = node.find("scene")) exclusion.scene = scene->text();
  const auto limit = [&](const char* key) -> std::optional<std::uint64_t> {
    const auto member = node.find(key);
    if (!member) return std::nullopt;
    return static_cast<std::uint64_t>(member->integer(0, INT64_MAX));
  };
  exclusion.primitives_above = limit("primitives_above");
  exclusion.rays_above = limit("rays_above");
  return exclusion;
}

void read_repetitions(const JsonNode& root, SweepConfig& config) {
  config.minimum_repetitions = 5;
  config.maximum_repetitions = 50;
  config.second_traces = 6;  // the fewest whose median has a 95% interval (see median_interval)
  const auto node = root.find("repetitions");
  if (!node) return;
  node->require_object({"minimum", "maximum", "second_traces"});
  if (const auto minimum = node->find("minimum")) {
    config.minimum_repetitions = static_cast<int>(minimum->integer(1, kMaxRepetitions));
    config.maximum_repetitions = std::max(config.maximum_repetitions, config.minimum_repetitions);
  }
  if (const auto maximum = node->find("maximum")) {
    config.maximum_repetitions =
        static_cast<int>(maximum->integer(config.minimum_repetitions, kMaxRepetitions));
  }
  if (const auto second_traces = node->find("second_traces")) {
    config.second_traces = static_cast<int>(second_traces->integer(0, kMaxRepetitions));
  }
}

Figure read_figure(const JsonNode& node) {
  const std::string name = node.text();
  if (name == "median") return Figure::kMedian;
  if (name == "minimum") return Figure::kMinimum;
  node.fail(fmt::format("expected median or minimum, not '{}'", name));
}

void read_effort(const JsonNode& root, SweepConfig& config) {
  const auto precision = root.find("precision");
  config.precision = precision ? precision->number(0.0, 1.0) : kDefaultPrecision;
  config.precise = Figure::kMedian;
  if (const auto figure = root.find("precision_of")) config.precise = read_figure(*figure);
  config.budget_seconds = root.require("budget_seconds").number(0.0, kMaxBudgetSeconds);
  const auto warm_up = root.find("warm_up_seconds");
  config.warm_up =
      std::chrono::duration<double>(warm_up ? warm_up->number(0.0, kMaxWarmUp) : kDefaultWarmUp);
  read_repetitions(root, config);
}

/// Refuses a file of rays that does not exist before hours are spent on other cells.
rays::RayChoice existing(rays::RayChoice choice) {
  if (!choice.file.empty() && !std::filesystem::is_regular_file(choice.file)) {
    throw InputError(fmt::format("there is no ray file '{}'; 'beambench rays' writes one",
                                 choice.file.string()));
  }
  return choice;
}

void read_rays(const JsonNode& root, SweepConfig& config) {
  for (const JsonNode& node : root.require("resolutions").elements()) {
    const std::string text = node.text();
    config.resolutions.push_back(node.checked([&] { return rays::parse_resolution(text); }));
  }
  config.samples = {1};
  if (const auto samples = root.find("samples")) {
    config.samples.clear();
    for (const JsonNode& node : samples->elements()) config.samples.push_back(read_samples(node));
  }
  for (const rays::Resolution& resolution : config.resolutions) {
    for (const int samples : config.samples) {
      root.checked([&] { rays::require_ray_count(resolution, samples); });
    }
  }
  config.rays = {rays::RayChoice()};
  if (const auto rays = root.find("rays")) {
    config.rays.clear();
    for (const JsonNode& node : rays->elements()) {
      const std::string name = node.text();
      config.rays.push_back(node.checked([&] { return existing(rays::parse_ray_choice(name)); }));
    }
  }
}

int read_threads(const JsonNode& root, const SweepConfig& config) {
  const auto node = root.find("threads");
  if (!node) return 1;
  const int threads = static_cast<int>(node->integer(1, kMaxThreads));
  for (const rays::RayChoice& rays : config.rays) {
    if (threads == 1 || rays == rays::RayChoice()) continue;
    node->fail(
        "only images of primary rays are traced on several threads; leave out the other "
        "rays or 'threads'");
  }
  return threads;
}

}  // namespace

SweepConfig read_sweep(const std::string& asked, const accel::Registry& structures) {
  const std::filesystem::path path = find_sweep(asked);
  return parse_sweep(read_json_file<nlohmann::json>(path), path.string(), structures);
}

SweepConfig parse_sweep(nlohmann::json source, const std::string& name,
                        const accel::Registry& structures) {
  SweepConfig config{};
  config.source = std::move(source);
  const JsonNode root(config.source, name);
  root.require_object({"$schema", "name", "description", "scenes", "structures", "resolutions",
                       "samples", "rays", "threads", "precision", "precision_of", "repetitions",
                       "budget_seconds", "warm_up_seconds", "exclude"});
  require_affordable(root, listed_structures(root));
  config.name = read_name(root.require("name"));
  if (const auto description = root.find("description")) config.description = description->text();
  for (const JsonNode& node : root.require("scenes").elements()) {
    config.scenes.push_back(read_scene(node));
  }
  for (const JsonNode& node : root.require("structures").elements()) {
    std::ranges::move(read_structure_entry(node, structures),
                      std::back_inserter(config.structures));
    require_affordable(root, static_cast<double>(config.structures.size()));  // `all` are many
  }
  read_rays(root, config);
  config.threads = read_threads(root, config);
  read_effort(root, config);
  if (const auto exclude = root.find("exclude")) {
    for (const JsonNode& node : exclude->elements()) {
      config.exclude.push_back(read_exclusion(node, structures));
    }
  }
  return config;
}

}  // namespace beambench::measure

#include "harness/measure/config.hpp"

#include <algorithm>
#include <iterator>
#include <set>

#include <fmt/format.h>

#include "accel/core/primary_rays.hpp"
#include "harness/measure/find_sweep.hpp"
#include "harness/measure/json_node.hpp"
#include "harness/measure/sweep_schema.hpp"
#include "harness/measure/tuning.hpp"
#include "scenes/base/json_text.hpp"

namespace beambench::measure {
namespace {

/// The maximum number of cells, more than any run measures: with six repetitions of one millisecond
/// each, they take ten minutes.
constexpr double kMaxCells = 100'000;

/// Returns the length of a list; 1 for any other value.
double length(const nlohmann::json& value) {
  return value.is_array() ? static_cast<double>(value.size()) : 1.0;
}

/// Returns the length of a member; 1 if it is missing.
double length_of(const nlohmann::json& object, const char* key) {
  return object.is_object() && object.contains(key) ? length(object[key]) : 1.0;
}

/// Returns the number of combinations of one entry's parameter lists.
double combinations(const nlohmann::json& entry) {
  double product = 1.0;
  if (!entry.is_object() || !entry.contains("parameters")) return product;
  const nlohmann::json& parameters = entry["parameters"];
  if (!parameters.is_object()) return product;  // items() of a list are its elements
  for (const auto& [name, values] : parameters.items()) product *= length(values);
  return product;
}

/// Returns the sum over the entries of a list; 1 if the list is missing.
template <class Count>
double sum_of(const nlohmann::json& root, const char* key, Count count) {
  if (!root.is_object() || !root.contains(key) || !root[key].is_array()) return 1.0;
  double sum = 0.0;
  for (const nlohmann::json& entry : root[key]) sum += count(entry);
  return sum;
}

/// Returns the number of structures that the document lists, before any are created. A string
/// counts once, even `all`.
double listed_structures(const JsonNode& root) {
  return sum_of(root.value(), "structures", combinations);
}

/// Refuses a sweep whose lists multiply to too many cells. Ignores errors in the lists, which are
/// found when the lists are read.
void require_affordable(const JsonNode& root, double structures) {
  const nlohmann::json& json = root.value();
  const double views = sum_of(json, "scenes", [](const auto& entry) {
    return length_of(entry, "cameras") * length_of(entry, "frames");
  });
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

/// A parameter and its values.
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
    // Each value is checked alone, so that the message names it; parameters are independent of each
    // other.
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

/// Returns the contenders of an entry: either a string as after `--accel` ("samet:max_level=6",
/// "all", "embree:mode=best"), or an object {"structure": name, "parameters": {name: value or list
/// of values}, "tune": true or false} for all combinations of the listed values, with the
/// alphabetically last parameter varying fastest.
std::vector<SweptStructure> read_structure_entry(const JsonNode& node,
                                                 const accel::Registry& structures) {
  if (node.value().is_string()) {
    const std::string text = node.text();
    return node.checked([&] { return read_structures(text, structures); });
  }
  const JsonNode name_node = *node.find("structure");
  const std::string name = name_node.text();
  name_node.checked([&] { return structures.choose({name, {}}); });
  std::vector<SweptParameter> parameters;
  if (const auto given = node.find("parameters")) {
    for (const auto& [key, value] : given->members()) {
      parameters.push_back(read_parameter(name, key, value, structures));
    }
  }
  std::vector<SweptStructure> swept;
  for (const Spec& spec : multiply_out(name, parameters)) {
    swept.push_back({{structures.choose(spec)}});
  }
  if (!node.value().value("tune", false)) return swept;
  if (swept.size() > kMaxParameterSets) {
    node.fail(
        fmt::format("its lists multiply to {} parameter sets; tuning tries the same number for "
                    "every contender, at most {}",
                    swept.size(), kMaxParameterSets));
  }
  SweptStructure tuned{{}, true};
  for (SweptStructure& one : swept) tuned.sets.push_back(std::move(one.sets.front()));
  return {tuned};
}

/// Refuses two tuned entries for one structure, whose rows would look the same.
void require_tuned_once(const JsonNode& root, const std::vector<SweptStructure>& structures) {
  std::set<std::string> tuned;
  for (const SweptStructure& each : structures) {
    if (!each.is_tuned || tuned.insert(each.sets.front().info().name).second) continue;
    root.find("structures")
        ->fail(fmt::format("'{}' is tuned twice; put all of its parameter sets into one entry",
                           each.sets.front().info().name));
  }
}

/// Returns an entry's scene; if the entry lists frames, the scene in each of these frames.
std::vector<SceneEntry> read_scene(const JsonNode& node) {
  if (node.value().is_string()) return {{node.text(), {}, node.place()}};
  SceneEntry entry{node.find("scene")->text(), {}, node.place()};
  if (const auto cameras = node.find("cameras")) {
    for (const JsonNode& camera : cameras->elements()) entry.cameras.push_back(camera.text());
  }
  const auto frames = node.find("frames");
  if (!frames) return {entry};
  std::vector<SceneEntry> entries;
  for (const JsonNode& frame : frames->elements()) {
    entries.push_back(entry);
    entries.back().spec += fmt::format("@{}", frame.value().get<std::uint32_t>());
  }
  return entries;
}

int read_samples(const JsonNode& node) {
  const int samples = node.value().get<int>();
  node.checked([&] { return accel::sample_offsets(samples); });
  return samples;
}

Exclusion read_exclusion(const JsonNode& node, const accel::Registry& structures) {
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
    return member->value().get<std::uint64_t>();
  };
  exclusion.primitives_above = limit("primitives_above");
  exclusion.rays_above = limit("rays_above");
  if (const auto order = node.find("order"))
    exclusion.is_sorted = order->text() == rays::kSortedOrder;
  return exclusion;
}

void read_repetitions(const JsonNode& root, SweepConfig& config) {
  const auto node = root.find("repetitions");
  const nlohmann::json given = node ? node->value() : nlohmann::json::object();
  config.blocks = root.value().value("blocks", 8);
  config.minimum_repetitions = given.value("minimum", 5);
  config.maximum_repetitions = given.value("maximum", std::max(50, config.minimum_repetitions));
  // Six is the smallest number whose median has a 95% interval (see median_interval).
  config.second_traces = given.value("second_traces", 6);
  if (config.maximum_repetitions < config.minimum_repetitions) {
    node->find("maximum")->fail(
        fmt::format("expected a whole number from {} (the minimum) on; found {}",
                    config.minimum_repetitions, config.maximum_repetitions));
  }
}

void read_effort(const JsonNode& root, SweepConfig& config) {
  const nlohmann::json& json = root.value();
  config.precision = json.value("precision", 0.02);
  config.budget_seconds = json.at("budget_seconds").get<double>();
  config.warm_up = std::chrono::duration<double>(json.value("warm_up_seconds", 0.5));
  read_repetitions(root, config);
}

/// Refuses a ray file that does not exist, before hours are spent on other cells.
rays::RayChoice existing(rays::RayChoice choice) {
  if (!choice.file.empty() && !std::filesystem::is_regular_file(choice.file)) {
    throw InputError(fmt::format("there is no ray file '{}'; 'beambench rays' writes one",
                                 choice.file.string()));
  }
  return choice;
}

void read_rays(const JsonNode& root, SweepConfig& config) {
  for (const JsonNode& node : root.find("resolutions")->elements()) {
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
  const int threads = node->value().get<int>();
  for (const rays::RayChoice& rays : config.rays) {
    if (threads == 1 || rays.kind != rays::RayKind::kWhitted) continue;
    node->fail("pictures are drawn on one thread; leave out 'whitted' or 'threads'");
  }
  return threads;
}

}  // namespace

std::vector<SweptStructure> read_structures(const std::string& text,
                                            const accel::Registry& structures) {
  std::vector<SweptStructure> swept;
  for (const Spec& spec : parse_spec_list(text)) {
    if (spec == kBestEmbree) {
      swept.push_back({best_embree(structures), true});
    } else {
      for (auto& choice : structures.choose_all(spec)) swept.push_back({{std::move(choice)}});
    }
  }
  return swept;
}

SweepConfig read_sweep(const std::string& asked, const accel::Registry& structures) {
  const std::filesystem::path path = find_sweep(asked);
  return parse_sweep(read_json_file<nlohmann::json>(path), path.string(), structures);
}

SweepConfig parse_sweep(nlohmann::json source, const std::string& name,
                        const accel::Registry& structures) {
  SweepConfig config{};
  config.source = std::move(source);
  const JsonNode root(config.source, name);
  require_sweep_form(config.source, name);
  require_affordable(root, listed_structures(root));
  config.name = root.find("name")->text();
  if (const auto description = root.find("description")) config.description = description->text();
  for (const JsonNode& node : root.find("scenes")->elements()) {
    std::ranges::move(read_scene(node), std::back_inserter(config.scenes));
  }
  for (const JsonNode& node : root.find("structures")->elements()) {
    std::ranges::move(read_structure_entry(node, structures),
                      std::back_inserter(config.structures));
    require_affordable(root, static_cast<double>(config.structures.size()));  // `all` means many
  }
  require_tuned_once(root, config.structures);
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

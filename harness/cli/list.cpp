// beambench list: lists structures, scenes, kinds of rays and plug-ins.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "accel/core/registry.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/text.hpp"
#include "harness/plugin/load_plugin.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/ray_kind.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/json_text.hpp"
#include "scenes/base/nearest_name.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/formats/mesh/mesh_registry.hpp"

namespace beambench::cli {
namespace {

using Json = nlohmann::ordered_json;

std::string_view conformance_name(accel::Conformance conformance) {
  switch (conformance) {
    case accel::Conformance::kBitExact:
      return "bit-exact";
    case accel::Conformance::kTolerance:
      return "tolerance";
    case accel::Conformance::kBaseline:
      break;
  }
  return "baseline";
}

std::string_view type_name(ParameterInfo::Type type) {
  switch (type) {
    case ParameterInfo::Type::kInteger:
      return "integer";
    case ParameterInfo::Type::kIntegerOrAuto:
      return "integer or auto";
    case ParameterInfo::Type::kReal:
      return "real";
    case ParameterInfo::Type::kFlag:
      return "flag";
    case ParameterInfo::Type::kCells:
      return "cells";
    case ParameterInfo::Type::kChoice:
      break;
  }
  return "choice";
}

bool has_range(const ParameterInfo& info) {
  return info.type != ParameterInfo::Type::kFlag && info.type != ParameterInfo::Type::kChoice;
}

std::string range_text(const ParameterInfo& info) {
  if (info.type == ParameterInfo::Type::kCells) {
    return fmt::format("auto, N or NxNxN, each from {} to {}", info.minimum, info.maximum);
  }
  if (has_range(info)) {
    return fmt::format("{} from {} to {}", type_name(info.type), info.minimum, info.maximum);
  }
  if (info.type == ParameterInfo::Type::kFlag) return "true or false";
  return fmt::format("{}", fmt::join(info.choices, " | "));
}

std::string about_mesh(const std::string& name) {
  try {
    const scenes::mesh::RegisteredMesh mesh = scenes::mesh::find_registered_mesh(name);
    return mesh.about.empty() ? mesh.path.string() : mesh.about;
  } catch (const InputError& error) {
    return error.what();
  }
}

void print_parameters(const std::vector<ParameterInfo>& parameters) {
  for (const ParameterInfo& info : parameters) {
    fmt::print("      {}={}  ({})\n", info.name, info.default_value, range_text(info));
    fmt::print("{}", wrap(info.description, 10));
  }
}

/// Prints the meshes; an unreadable entry is shown with the reason.
void print_meshes() {
  fmt::print("\nMeshes, as mesh:NAME (scripts/meshes registers some):\n\n");
  const std::vector<std::string> names = scenes::mesh::registered_mesh_names();
  if (names.empty()) fmt::print("  none\n");
  for (const std::string& name : names) {
    fmt::print("  {}{}\n{}", scenes::mesh::kMeshPrefix, printable(name), wrap(about_mesh(name), 6));
  }
}

std::string origin_text(const std::string& origin) {
  return origin.empty() ? "" : fmt::format("  (of {})", origin);
}

/// Returns the number of frames of a scene with its defaults; 1 if it is not animated.
std::uint32_t frames_of(const scenes::SceneInfo& info) {
  if (!info.animate) return 1;
  const Parameters defaults(info.name, info.parameters, {});
  return static_cast<std::uint32_t>(defaults.integer(scenes::frames_parameter().name));
}

std::string note_on(const scenes::SceneInfo& info) {
  const std::uint32_t frames = frames_of(info);
  return (frames > 1 ? fmt::format("  [moves: {} frames]", frames) : "") + origin_text(info.origin);
}

void print_plugins() {
  if (plugin::loaded_plugins().empty()) return;
  if (!scenes::scene_readers().empty()) fmt::print("\nFurther formats of scene files, by path:\n");
  for (const scenes::SceneReader& reader : scenes::scene_readers()) {
    fmt::print("\n  *{}{}\n{}", reader.ending, origin_text(reader.origin), wrap(reader.summary, 6));
  }
  fmt::print("\nPlug-ins:\n");
  for (const plugin::LoadedPlugin& plugin : plugin::loaded_plugins()) {
    fmt::print("\n  {}\n{}", printable(plugin.file), wrap(plugin.description, 6));
    fmt::print("      hash {}, built by {}{}{}\n", rays::hex_digits(plugin.hash), plugin.compiler,
               plugin.instructions.empty() ? "" : " for " + plugin.instructions,
               plugin.optimized ? "" : ", without optimization");
  }
}

/// Prints a structure, scene or kind of rays; `note` is printed after its name.
template <class Info>
void print_entry(const Info& info, const std::string& note) {
  fmt::print("\n  {}{}\n{}", info.name, note, wrap(info.summary, 6));
  print_parameters(info.parameters);
}

/// Returns the instruction set of the SIMD code that a structure with its defaults runs on this
/// machine, as the structure states it; nothing if it does not use SIMD.
std::optional<std::string> simd_of(const accel::StructureInfo& info) {
  static const scenes::Scene scene = scenes::load_scene("tetra:n=1");
  try {
    const auto structure = accel::registry().choose({info.name, {}}).build(scene);
    const std::string isa = structure->statistics().instruction_set;
    return isa.empty() ? std::nullopt : std::optional(isa);
  } catch (const InputError&) {  // it cannot be built over this scene
    return std::nullopt;
  }
}

void print_structure(const accel::StructureInfo& info) {
  const auto simd = simd_of(info);
  print_entry(info, fmt::format("  [{}, {}]{}", conformance_name(info.conformance),
                                simd ? "SIMD: " + *simd : "no SIMD", origin_text(info.origin)));
}

void print_counters(std::span<const accel::CounterInfo> counters) {
  for (const accel::CounterInfo& info : counters) {
    fmt::print("      {}\n{}", info.name, wrap(info.meaning, 10));
  }
}

/// Prints the counters of each structure that has additional ones.
void print_all_counters() {
  fmt::print(
      "Counters, from a separate pass, never from timed code: for --heatmap, in 'beambench stats' "
      "and as\n"
      "columns of results.csv, NAME_per_ray.\n"
      "\n"
      "  every structure\n");
  print_counters(accel::common_counters());
  for (const accel::StructureInfo& info : accel::registry().structures()) {
    const auto own = accel::registry().own_counters(info.name);
    if (own.empty()) continue;
    fmt::print("\n  {}, too\n", info.name);
    print_counters(own);
  }
}

template <class Info>
const Info* find_named(std::span<const Info> infos, std::string_view name) {
  const auto found =
      std::ranges::find_if(infos, [&](const Info& info) { return info.name == name; });
  return found == infos.end() ? nullptr : &*found;
}

[[noreturn]] void refuse_name(const std::string& name) {
  std::vector<std::string> names;
  for (const accel::StructureInfo& info : accel::registry().structures())
    names.push_back(info.name);
  for (const scenes::SceneInfo& info : scenes::scene_catalogue()) names.push_back(info.name);
  for (const rays::RayKindInfo& info : rays::ray_kinds()) names.emplace_back(info.name);
  throw InputError(fmt::format(
      "there is no structure, scene or kind of rays '{}'; {}'beambench list' prints all", name,
      did_you_mean(name, names)));
}

/// Prints everything with that name, ignoring the part after a colon.
void print_named(const std::string& spec) {
  const std::string name = spec.substr(0, spec.find(':'));
  const accel::StructureInfo* structure = find_named(accel::registry().structures(), name);
  const scenes::SceneInfo* scene = find_named(scenes::scene_catalogue(), name);
  const rays::RayKindInfo* rays = find_named(rays::ray_kinds(), name);
  if (structure == nullptr && scene == nullptr && rays == nullptr) refuse_name(name);
  if (structure != nullptr) {
    fmt::print("Structure, for --accel {}:parameter=value,...\n", name);
    print_structure(*structure);
    if (const auto own = accel::registry().own_counters(name); !own.empty()) {
      fmt::print("\n    its own counters, in addition to the common ones (--counters):\n");
      print_counters(own);
    }
  }
  if (scene != nullptr) {
    fmt::print("Scene, as {}:parameter=value,...\n", name);
    print_entry(*scene, note_on(*scene));
  }
  if (rays != nullptr) {
    fmt::print("Kind of rays, for --rays {}:parameter=value,...\n", name);
    print_entry(*rays, "");
  }
}

void print_text() {
  fmt::print("Structures, for --accel NAME:parameter=value,... ('all' for every one):\n");
  for (const accel::StructureInfo& info : accel::registry().structures()) print_structure(info);
  fmt::print("\n{}",
             wrap("bit-exact: hits equal to exhaustive, bit for bit; tolerance: its own "
                  "arithmetic, verified by the differ's classes; baseline: finds no hits by "
                  "design. SIMD: the instruction set that it uses here with its defaults.",
                  2));
  fmt::print("\nScenes, as NAME:parameter=value,... (or the path of a mesh or of an NFF file):\n");
  print_parameters({scenes::perturb_parameter()});
  for (const scenes::SceneInfo& info : scenes::scene_catalogue()) {
    print_entry(info, note_on(info));
  }
  print_meshes();
  print_plugins();
  fmt::print("\nKinds of rays, for --rays (or the path of a .rays file, see 'beambench rays'):\n");
  for (const rays::RayKindInfo& info : rays::ray_kinds()) print_entry(info, "");
}

Json counters_json(std::span<const accel::CounterInfo> counters) {
  Json list = Json::array();
  for (const accel::CounterInfo& info : counters) {
    list.push_back({{"name", info.name}, {"meaning", info.meaning}});
  }
  return list;
}

Json parameters_json(const std::vector<ParameterInfo>& parameters) {
  Json list = Json::array();
  for (const ParameterInfo& info : parameters) {
    Json entry{
        {"name", info.name}, {"type", type_name(info.type)}, {"default", info.default_value}};
    if (has_range(info)) {
      entry["minimum"] = info.minimum;
      entry["maximum"] = info.maximum;
    }
    if (info.type == ParameterInfo::Type::kChoice) entry["choices"] = info.choices;
    entry["description"] = info.description;
    list.push_back(std::move(entry));
  }
  return list;
}

Json origin_json(const std::string& origin) {
  return origin.empty() ? Json("built in") : Json(origin);
}

void print_json() {
  Json all;
  for (const accel::StructureInfo& info : accel::registry().structures()) {
    const auto simd = simd_of(info);
    all["structures"].push_back(
        {{"name", info.name},
         {"summary", info.summary},
         {"conformance", conformance_name(info.conformance)},
         {"simd", simd ? Json(*simd) : Json()},
         {"origin", origin_json(info.origin)},
         {"parameters", parameters_json(info.parameters)},
         {"counters", counters_json(accel::registry().own_counters(info.name))}});
  }
  all["counters"] = counters_json(accel::common_counters());
  for (const scenes::SceneInfo& info : scenes::scene_catalogue()) {
    all["scenes"].push_back({{"name", info.name},
                             {"summary", info.summary},
                             {"origin", origin_json(info.origin)},
                             {"frames", frames_of(info)},
                             {"parameters", parameters_json(info.parameters)}});
  }
  all["readers"] = Json::array();
  for (const scenes::SceneReader& reader : scenes::scene_readers()) {
    all["readers"].push_back(
        {{"ending", reader.ending}, {"summary", reader.summary}, {"origin", reader.origin}});
  }
  all["meshes"] = Json::array();
  for (const std::string& name : scenes::mesh::registered_mesh_names()) {
    all["meshes"].push_back({{"name", fmt::format("{}{}", scenes::mesh::kMeshPrefix, name)},
                             {"about", about_mesh(name)}});
  }
  for (const rays::RayKindInfo& info : rays::ray_kinds()) {
    all["rays"].push_back({{"name", info.name},
                           {"summary", info.summary},
                           {"query", rays::to_string(info.query)},
                           {"parameters", parameters_json(info.parameters)}});
  }
  fmt::print("{}\n", json_text(all));
}

struct ListRequest {
  std::vector<std::string> names;
  bool counters = false;
  bool json = false;
};

void list(const ListRequest& request) {
  if (request.json) return print_json();
  if (request.counters) return print_all_counters();
  if (request.names.empty()) return print_text();
  for (const std::string& name : request.names) print_named(name);
}

}  // namespace

void add_list_command(CLI::App& app, int&) {
  CLI::App* command =
      app.add_subcommand("list", "List structures, scenes and kinds of rays with their parameters");
  const auto request = std::make_shared<ListRequest>();
  CLI::Option* names = command->add_option(
      "NAME", request->names, "Structures, scenes or kinds of rays to print (default: all)");
  CLI::Option* counters =
      command->add_flag("--counters", request->counters, "Print the work counters instead");
  command->add_flag("--json", request->json, "Print everything, as JSON instead of text")
      ->excludes(names)
      ->excludes(counters);
  counters->excludes(names);
  command->footer(
      "Examples:\n"
      "  beambench list\n"
      "  beambench list samet balls\n"
      "  beambench list --counters\n"
      "  beambench list --json");
  command->callback([request] { list(*request); });
}

}  // namespace beambench::cli

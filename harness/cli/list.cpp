// beambench list: what can be asked for.

#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "accel/registry.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/text.hpp"
#include "harness/plugin/load_plugin.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/rays/ray_kind.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/error.hpp"
#include "scenes/meshes/mesh_registry.hpp"

namespace beambench {
namespace {

using Json = nlohmann::ordered_json;

std::string_view conformance_name(Conformance conformance) {
  switch (conformance) {
    case Conformance::kBitExact:
      return "bit-exact";
    case Conformance::kTolerance:
      return "tolerance";
    case Conformance::kBaseline:
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
    const RegisteredMesh mesh = find_registered_mesh(name);
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

/// An entry that cannot be read is shown with the reason.
void print_meshes() {
  fmt::print("\nMeshes, as mesh:NAME (scripts/meshes registers some):\n\n");
  const std::vector<std::string> names = registered_mesh_names();
  if (names.empty()) fmt::print("  none\n");
  for (const std::string& name : names) {
    fmt::print("  {}{}\n{}", kMeshPrefix, name, wrap(about_mesh(name), 6));
  }
}

std::string origin_text(const std::string& origin) {
  return origin.empty() ? "" : fmt::format("  (of {})", origin);
}

void print_plugins() {
  if (loaded_plugins().empty()) return;
  if (!scene_readers().empty()) fmt::print("\nFurther formats of scene files, by path:\n");
  for (const SceneReader& reader : scene_readers()) {
    fmt::print("\n  *{}{}\n{}", reader.ending, origin_text(reader.origin), wrap(reader.summary, 6));
  }
  fmt::print("\nPlug-ins:\n");
  for (const LoadedPlugin& plugin : loaded_plugins()) {
    fmt::print("\n  {}\n{}", plugin.file, wrap(plugin.description, 6));
    fmt::print("      hash {}, built by {} for {}{}\n", hex_digits(plugin.hash), plugin.compiler,
               plugin.instructions, plugin.optimised ? "" : ", without optimisation");
  }
}

void print_text() {
  fmt::print("Structures, for --accel NAME:parameter=value,... ('all' is every one):\n");
  for (const StructureInfo& info : registry().structures()) {
    fmt::print("\n  {}  [{}]{}\n{}", info.name, conformance_name(info.conformance),
               origin_text(info.origin), wrap(info.summary, 6));
    print_parameters(info.parameters);
  }
  fmt::print("\n{}", wrap("bit-exact: equal to exhaustive bit for bit; tolerance: arithmetic of "
                          "its own, judged by the differ's classes; baseline: answers nothing by "
                          "design.",
                          2));
  fmt::print("\nScenes, as NAME:parameter=value,... (or the path of a mesh or of an NFF file):\n");
  for (const SceneInfo& info : scene_catalogue()) {
    fmt::print("\n  {}{}\n{}", info.name, origin_text(info.origin), wrap(info.summary, 6));
    print_parameters(info.parameters);
  }
  print_meshes();
  print_plugins();
  fmt::print("\nKinds of rays, for --rays (or the path of a .rays file, see 'beambench rays'):\n");
  for (const RayKindInfo& info : ray_kinds()) {
    fmt::print("\n  {}\n{}", info.name, wrap(info.summary, 6));
    print_parameters(info.parameters);
  }
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
  for (const StructureInfo& info : registry().structures()) {
    all["structures"].push_back({{"name", info.name},
                                 {"summary", info.summary},
                                 {"conformance", conformance_name(info.conformance)},
                                 {"origin", origin_json(info.origin)},
                                 {"parameters", parameters_json(info.parameters)}});
  }
  for (const SceneInfo& info : scene_catalogue()) {
    all["scenes"].push_back({{"name", info.name},
                             {"summary", info.summary},
                             {"origin", origin_json(info.origin)},
                             {"parameters", parameters_json(info.parameters)}});
  }
  all["readers"] = Json::array();
  for (const SceneReader& reader : scene_readers()) {
    all["readers"].push_back(
        {{"ending", reader.ending}, {"summary", reader.summary}, {"origin", reader.origin}});
  }
  all["meshes"] = Json::array();
  for (const std::string& name : registered_mesh_names()) {
    all["meshes"].push_back(
        {{"name", fmt::format("{}{}", kMeshPrefix, name)}, {"about", about_mesh(name)}});
  }
  for (const RayKindInfo& info : ray_kinds()) {
    all["rays"].push_back({{"name", info.name},
                           {"summary", info.summary},
                           {"query", to_string(info.query)},
                           {"parameters", parameters_json(info.parameters)}});
  }
  fmt::print("{}\n", all.dump(2));
}

}  // namespace

void add_list_command(CLI::App& app, int&) {
  CLI::App* command =
      app.add_subcommand("list", "Structures with their parameters, scenes, kinds of rays");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Print JSON instead of text");
  command->footer("Examples:\n  beambench list\n  beambench list --json");
  command->callback([json] { *json ? print_json() : print_text(); });
}

}  // namespace beambench

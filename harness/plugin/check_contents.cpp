#include "harness/plugin/check_contents.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "scenes/core/plugin_error.hpp"

namespace beambench::plugin {
namespace {

/// Names that commands give a meaning of their own.
constexpr std::array<std::string_view, 2> kReserved{"all", "oracle"};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool is_name(std::string_view text) {
  return !text.empty() && is_letter(text.front()) && std::ranges::all_of(text, [](char c) {
    return is_letter(c) || is_digit(c) || c == '-' || c == '_';
  });
}

/// Names of one kind of thing: each at most once.
class Names {
 public:
  Names(std::string_view what, std::set<std::string> taken)
      : what_(what), taken_(std::move(taken)) {}

  void take(const std::string& name) {
    if (!is_name(name) || std::ranges::find(kReserved, name) != kReserved.end()) {
      throw PluginError(fmt::format(
          "calls a {} '{}', which is no name; take letters, digits, '-' and '_', a letter first, "
          "and neither 'all' nor 'oracle'",
          what_, name));
    }
    if (!taken_.insert(name).second) {
      throw PluginError(
          fmt::format("brings a {} '{}', but there is one of that name already; "
                      "rename it",
                      what_, name));
    }
  }

 private:
  std::string_view what_;
  std::set<std::string> taken_;
};

template <class Infos>
std::set<std::string> names_of(const Infos& infos) {
  std::set<std::string> names;
  for (const auto& info : infos) names.insert(info.name);
  return names;
}

void require(bool right, std::string_view what, const std::string& name, std::string_view lack) {
  if (!right) throw PluginError(fmt::format("brings a {} '{}' {}", what, name, lack));
}

/// Its parameters, each set to its default, must pass the check that a user's values have to pass.
void check_parameters(std::string_view what, const std::string& owner,
                      const std::vector<ParameterInfo>& infos) {
  Names names(fmt::format("parameter of '{}'", owner), {});
  std::vector<std::pair<std::string, std::string>> defaults;
  for (const ParameterInfo& info : infos) {
    names.take(info.name);
    defaults.emplace_back(info.name, info.default_value);
  }
  try {
    const Parameters checked(owner, infos, defaults);
  } catch (const std::exception& error) {
    throw PluginError(fmt::format("brings a {} '{}' whose defaults it would refuse: {}", what,
                                  owner, error.what()));
  }
}

void check_reader(const scenes::SceneReader& reader, std::set<std::string>& endings) {
  const std::string& ending = reader.ending;
  const bool sound = ending.size() > 1 && ending.front() == '.' &&
                     std::ranges::all_of(ending, [](unsigned char c) {
                       return c == '.' || std::isdigit(c) != 0 || std::islower(c) != 0;
                     });
  require(sound, "reader of files", ending,
          "whose ending is none: a dot, then small letters and digits");
  require(!scenes::is_scene_file("file" + ending) && endings.insert(ending).second,
          "reader of files", ending, "but such files are read already");
  require(!reader.summary.empty(), "reader of files", ending, "without a summary");
  require(static_cast<bool>(reader.read), "reader of files", ending, "without a function to read");
}

}  // namespace

void check_contents(const PluginContents& contents) {
  if (contents.structures.empty() && contents.scenes.empty() && contents.readers.empty()) {
    throw PluginError("brings nothing: neither structures nor scenes nor readers of files");
  }
  Names structures("structure", names_of(accel::registry().structures()));
  for (const accel::StructureInfo& info : contents.structures) {
    structures.take(info.name);
    require(!info.summary.empty(), "structure", info.name, "without a summary");
    require(static_cast<bool>(info.build), "structure", info.name, "without a function to build");
    check_parameters("structure", info.name, info.parameters);
  }
  Names scenes("scene", names_of(scenes::scene_catalogue()));
  for (const scenes::SceneInfo& info : contents.scenes) {
    scenes.take(info.name);
    require(!info.summary.empty(), "scene", info.name, "without a summary");
    require(static_cast<bool>(info.generate), "scene", info.name, "without a function to generate");
    check_parameters("scene", info.name, info.parameters);
  }
  std::set<std::string> endings;
  for (const scenes::SceneReader& reader : contents.readers) check_reader(reader, endings);
}

}  // namespace beambench::plugin

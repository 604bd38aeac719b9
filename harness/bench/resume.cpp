#include "harness/bench/resume.hpp"

#include <map>
#include <string>

#include <fmt/format.h>

#include "scenes/core/error.hpp"
#include "scenes/core/shell_word.hpp"

namespace beambench::bench {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void refuse(const RunFolder& folder, const std::string& reason) {
  throw InputError(fmt::format("cannot resume '{}': {}; begin a new run with -o",
                               folder.path().string(), reason));
}

void require_same_config(const RunFolder& folder, const nlohmann::json& config) {
  const nlohmann::json then = folder.read_json("config.json");
  const nlohmann::json changes = nlohmann::json::diff(then, config);
  if (changes.empty()) return;
  refuse(folder, fmt::format("the configuration has changed at {}",
                             changes.front().at("path").get<std::string>()));
}

/// A member of a manifest as text, whatever it is; empty where there is none.
std::string member(const Json& manifest, const char* pointer) {
  const Json::json_pointer place(pointer);
  return manifest.contains(place) ? manifest.at(place).dump() : "";
}

void require_same_program(const RunFolder& folder, const Json& then, const Json& now) {
  const auto differs = [&](const char* pointer) {
    return member(then, pointer) != member(now, pointer);
  };
  if (differs("/program/commit")) {
    refuse(folder, fmt::format("it was begun by beambench of commit {}, this one is of {}",
                               member(then, "/program/commit"), member(now, "/program/commit")));
  }
  if (differs("/program/executable_hash")) {
    refuse(folder,
           "it was begun by another build of beambench, from changed sources or with other "
           "options");
  }
  if (differs("/machine/id")) refuse(folder, "it was begun on another machine");
}

/// The plug-ins of a manifest: hash by file.
std::map<std::string, std::string> plugins_of(const Json& manifest) {
  std::map<std::string, std::string> plugins;
  for (const Json& plugin : manifest.value("plugins", Json::array())) {
    plugins[plugin.at("file").get<std::string>()] = plugin.at("hash").get<std::string>();
  }
  return plugins;
}

void require_same_plugins(const RunFolder& folder, const Json& then, const Json& now) {
  const auto plugins = plugins_of(now);
  for (const auto& [file, hash] : plugins_of(then)) {
    const auto found = plugins.find(file);
    if (found == plugins.end()) {
      refuse(folder, fmt::format("it was begun with --plugin {}", shell_quoted(file)));
    }
    if (found->second != hash) {
      refuse(folder, fmt::format("the plug-in {} has changed since", file));
    }
  }
}

void require_same_scenes(const RunFolder& folder, const Json& then, const Json& now) {
  for (const Json& scene : now.at("scenes")) {
    for (const Json& earlier : then.value("scenes", Json::array())) {
      if (earlier.at("name") != scene.at("name")) continue;
      if (earlier.at("hash") == scene.at("hash")) continue;
      refuse(folder, fmt::format("the scene {} has changed since", scene.at("name").dump()));
    }
  }
}

}  // namespace

void require_same_run(const RunFolder& folder, const nlohmann::json& config, const Json& manifest) {
  const Json then = folder.read_json("manifest.json");
  require_same_config(folder, config);
  require_same_program(folder, then, manifest);
  require_same_plugins(folder, then, manifest);
  require_same_scenes(folder, then, manifest);
}

}  // namespace beambench::bench

#include "harness/plugin/load_plugin.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "accel/core/extend_registry.hpp"
#include "harness/plugin/check_contents.hpp"
#include "harness/plugin/check_scene.hpp"
#include "harness/plugin/foreign_call.hpp"
#include "harness/plugin/guarded_structure.hpp"
#include "harness/rays/fingerprint.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/core/error.hpp"
#include "scenes/core/plugin_error.hpp"
#include "scenes/core/shell_word.hpp"

namespace beambench::plugin {
namespace {

constexpr const char* kEntry = "beambench_plugin";
/// A plug-in that has not ended its start by then never will.
constexpr unsigned kSecondsToLoad = 10;

std::vector<LoadedPlugin>& all_loaded() {
  static std::vector<LoadedPlugin> all;
  return all;
}

std::string& program_name() {
  static std::string name = "beambench";
  return name;
}

std::string call_with_plugins(std::string_view program) {
  std::string call = shell_quoted(program);
  for (const LoadedPlugin& plugin : all_loaded()) {
    call += " --plugin " + shell_quoted(plugin.file);
  }
  return call;
}

[[noreturn]] void refuse(const std::string& file, std::string_view why) {
  throw InputError(fmt::format("the plug-in {} {}", file, why));
}

/// What the loader says names the file once more, and nobody needs it twice.
std::string loader_message(const std::string& path) {
  const char* told = ::dlerror();
  std::string_view message = told == nullptr ? "no reason was given" : told;
  if (message.starts_with(path + ": ")) message.remove_prefix(path.size() + 2);
  return std::string(message);
}

/// Ends the process when loading hangs; whoever guards it sees by which signal.
class LoadingTime {
 public:
  LoadingTime() { ::alarm(kSecondsToLoad); }
  ~LoadingTime() { ::alarm(0); }
  LoadingTime(const LoadingTime&) = delete;
  LoadingTime& operator=(const LoadingTime&) = delete;
};

/// Stays loaded until the program ends: what it brings is code.
const Plugin& open(const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::exists(file, error)) refuse(file, "is not there; check the path after --plugin");
  if (!fs::is_regular_file(file, error)) refuse(file, "is not a file; name a shared object");
  const std::string path =
      fs::absolute(file).string();  // a bare name would be looked for elsewhere
  void* object = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (object == nullptr) {
    refuse(file, fmt::format("cannot be loaded: {}; build it with beambench_add_plugin",
                             loader_message(path)));
  }
  const void* entry = ::dlsym(object, kEntry);
  if (entry == nullptr) {
    refuse(file, fmt::format("is no plug-in of beambench: it defines no '{}'; see 'Bring your own "
                             "structure' in the README",
                             kEntry));
  }
  return *static_cast<const Plugin*>(entry);
}

constexpr std::string_view kBuildAgain =
    "build it again with the headers of this beambench, and options that change none of its types";

/// Reads no further than what it knows to be there.
void require_same_stamp(const std::string& file, const PluginStamp& stamp) {
  if (stamp.magic != kPluginStamp.magic) {
    refuse(file, fmt::format("is no plug-in of beambench: its '{}' is something else", kEntry));
  }
  if (stamp.interface_version != kPluginStamp.interface_version) {
    refuse(file, fmt::format("was built for version {} of the interface, this program has {}; {}",
                             stamp.interface_version, kPluginStamp.interface_version, kBuildAgain));
  }
  if (std::strcmp(stamp.library, kPluginStamp.library) != 0) {
    refuse(file, fmt::format("was built with {}, this program with {}; {}", stamp.library,
                             kPluginStamp.library, kBuildAgain));
  }
  if (stamp.layout != kPluginStamp.layout) {
    refuse(file, fmt::format("has other types than this program, though its interface's version is "
                             "the same; {}",
                             kBuildAgain));
  }
}

PluginContents contents_of(const std::string& file, const Plugin& plugin) {
  if (plugin.fill == nullptr) refuse(file, "has no function to fill in what it brings");
  PluginContents contents;
  try {
    foreign_call(file, "while it was loaded", [&] { plugin.fill(contents); });
  } catch (const PluginError& error) {
    throw InputError(error.what());
  }
  try {
    check_contents(contents);
  } catch (const PluginError& error) {
    refuse(file, error.what());
  }
  return contents;
}

template <class Thing>
std::vector<std::string> names_of(const std::vector<Thing>& things, std::string Thing::*name) {
  std::vector<std::string> names;
  names.reserve(things.size());
  for (const Thing& thing : things) names.push_back(thing.*name);
  return names;
}

std::uint64_t fingerprint_of_file(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return rays::fingerprint(std::string(std::istreambuf_iterator<char>(stream), {}));
}

/// Calls `make`, which is the plug-in's, and looks its scene over.
template <class Make>
scenes::Scene guarded_scene(const std::string& file, const std::string& name, Activity& activity,
                            Make&& make) {
  activity.write(Activity::Line::kForeign, file, ": making the scene " + name);
  scenes::Scene scene =
      foreign_call(file, "when it made the scene " + name, std::forward<Make>(make));
  activity.clear(Activity::Line::kForeign);
  try {
    check_scene(scene);
  } catch (const PluginError& error) {
    throw PluginError(
        fmt::format("the plug-in {} made a broken scene {}: {}", file, name, error.what()));
  }
  return scene;
}

accel::StructureInfo guarded_thing(accel::StructureInfo info, Activity& activity) {
  return guarded(std::move(info), activity);
}

scenes::SceneInfo guarded_thing(scenes::SceneInfo info, Activity& activity) {
  info.generate = [generate = std::move(info.generate), file = info.origin,
                   &activity](const Parameters& parameters) {
    return guarded_scene(file, parameters.label(), activity, [&] {
      scenes::Scene made = generate(parameters);
      parameters.require_given_were_read();
      return made;
    });
  };
  return info;
}

scenes::SceneReader guarded_thing(scenes::SceneReader reader, Activity& activity) {
  reader.read = [read = std::move(reader.read), file = reader.origin, &activity](
                    const std::filesystem::path& path, std::vector<std::string>& warnings) {
    return guarded_scene(file, path.string(), activity, [&] { return read(path, warnings); });
  };
  return reader;
}

template <class Thing>
void adopt(std::vector<Thing>& things, const std::string& file, Activity& activity) {
  for (Thing& thing : things) {
    thing.origin = file;
    thing = guarded_thing(std::move(thing), activity);
  }
}

}  // namespace

void load_plugin(const std::string& file, Activity& activity) {
  const LoadingTime time;
  activity.write(Activity::Line::kForeign, file, ": loading it");
  const Plugin& plugin = open(file);
  require_same_stamp(file, plugin.stamp);
  PluginContents contents = contents_of(file, plugin);
  activity.clear(Activity::Line::kForeign);

  const PluginStamp& stamp = plugin.stamp;
  all_loaded().push_back({file, plugin.description == nullptr ? "" : plugin.description,
                          fingerprint_of_file(file), stamp.compiler, stamp.instructions,
                          stamp.optimized,
                          names_of(contents.structures, &accel::StructureInfo::name),
                          names_of(contents.scenes, &scenes::SceneInfo::name),
                          names_of(contents.readers, &scenes::SceneReader::ending)});
  adopt(contents.structures, file, activity);
  adopt(contents.scenes, file, activity);
  adopt(contents.readers, file, activity);
  accel::extend_registry(std::move(contents.structures));
  scenes::register_plugin_scenes(std::move(contents.scenes), std::move(contents.readers));
}

std::span<const LoadedPlugin> loaded_plugins() { return all_loaded(); }

std::string program_call() { return call_with_plugins("beambench"); }

void set_program_name(std::string_view word) { program_name() = word; }

std::string program_call_here() { return call_with_plugins(program_name()); }

}  // namespace beambench::plugin

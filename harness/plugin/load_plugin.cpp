#include "harness/plugin/load_plugin.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include <dlfcn.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include "accel/core/registry.hpp"
#include "harness/plugin/c_contenders.hpp"
#include "harness/plugin/guarded_structure.hpp"
#include "harness/plugin/program_contender.hpp"
#include "harness/plugin/validation.hpp"
#include "harness/rays/fingerprint.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/files.hpp"
#include "scenes/base/shell_word.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::plugin {
namespace {

constexpr const char* kEntry = "beambench_plugin";
constexpr const char* kContenders = "beambench_contenders";  // of the C interface
/// The time after which loading a plug-in counts as hanging.
constexpr unsigned kSecondsToLoad = 10;

std::vector<LoadedPlugin>& all_loaded() {
  static std::vector<LoadedPlugin> all;
  return all;
}

Activity*& recording() {
  static Activity* activity = nullptr;
  return activity;
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

/// Returns the loader's message without the file's name, which beambench's message already
/// contains.
std::string loader_message(const std::string& path) {
  const char* error = ::dlerror();
  std::string_view message = error == nullptr ? "no reason was given" : error;
  if (message.starts_with(path + ": ")) message.remove_prefix(path.size() + 2);
  return std::string(message);
}

/// Ends the process with SIGALRM if loading hangs; the guard reports it.
class LoadingTime {
 public:
  LoadingTime() { ::alarm(kSecondsToLoad); }
  ~LoadingTime() { ::alarm(0); }
  LoadingTime(const LoadingTime&) = delete;
  LoadingTime& operator=(const LoadingTime&) = delete;
};

/// What a plug-in provides, and how it was built.
struct OpenedPlugin {
  PluginContents contents;
  std::string description;
  std::string compiler;
  std::string instructions{};
  bool optimized = true;
};

void require_file(const std::string& file) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::exists(file, error)) refuse(file, "is not there; check the path after --plugin");
  if (!fs::is_regular_file(file, error)) {
    refuse(file, "is not a file; specify a shared object or a program");
  }
}

/// Returns whether a file is a program: it is executable, and its name does not contain `.so`.
bool is_program(const std::string& file) {
  return file.find(".so") == std::string::npos && ::access(file.c_str(), X_OK) == 0;
}

/// Opens a shared object, which stays loaded until the program ends, because the registry points to
/// its code.
void* open(const std::string& file) {
  namespace fs = std::filesystem;
  const std::string path =
      fs::absolute(file).string();  // a bare name would be searched for elsewhere
  void* object = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (object == nullptr) {
    refuse(file, fmt::format("cannot be loaded: {}; build it with beambench_add_plugin",
                             loader_message(path)));
  }
  return object;
}

constexpr std::string_view kBuildAgain =
    "build it again with the headers of this beambench and without options that change its types";

/// The changes of each version of the interface, from version 2 on.
constexpr auto kInterfaceChanges = std::to_array<std::string_view>({
    "statistics() reports how a structure gets the rays of an image",
    "each query exists once, with a pointer to counters, and a list of rays is a RayBatch",
    "a RayBatch has the sample of each ray, its pencils the virtual eye's image, and "
    "structures state where rays are in their beams",
    "statistics() names a library and its version, and add_tests counts tests by kind of primitive",
    "a parameter states whether its values may change hits",
    "two queries over a source of rays with a context, an inspector in place of diagnostics, what "
    "a "
    "structure supports, and update()",
    "a scene has a frame, and scenes of the catalog may move",
    "an inspector's occupied cells have levels",
});
static_assert(kInterfaceChanges.size() == kPluginInterface - 1);

void require_same_version(const std::string& file, std::uint32_t version) {
  if (version == kPluginInterface) return;
  std::string changes = "an older one";
  if (version < kPluginInterface) {
    changes = "and since then:";
    for (std::uint32_t later = std::max(version, 1U) + 1; later <= kPluginInterface; ++later) {
      changes += fmt::format(" {} (version {});", kInterfaceChanges[later - 2], later);
    }
    changes.pop_back();
  }
  refuse(file, fmt::format("was built for version {} of the interface, this program has {}, {}; {}",
                           version, kPluginInterface, changes, kBuildAgain));
}

/// Reads `layout` and the following members only if the version guarantees that they exist.
void require_same_stamp(const std::string& file, const PluginStamp& stamp) {
  if (stamp.magic != kPluginStamp.magic) {
    refuse(file, fmt::format("is not a beambench plug-in: its '{}' is not an entry point", kEntry));
  }
  require_same_version(file, stamp.interface_version);
  if (std::strcmp(stamp.library, kPluginStamp.library) != 0) {
    refuse(file, fmt::format("was built with {}, this program with {}; {}", stamp.library,
                             kPluginStamp.library, kBuildAgain));
  }
  if (stamp.layout != kPluginStamp.layout) {
    refuse(file, fmt::format("has other types than this program, although the interface version is "
                             "the same; {}",
                             kBuildAgain));
  }
}

OpenedPlugin filled_by(const std::string& file, const Plugin& plugin) {
  const PluginStamp& stamp = plugin.stamp;
  require_same_stamp(file, stamp);
  if (plugin.fill == nullptr) refuse(file, "has no function that fills in what it provides");
  OpenedPlugin opened{{},
                      plugin.description == nullptr ? "" : plugin.description,
                      stamp.compiler,
                      stamp.instructions,
                      stamp.optimized};
  try {
    foreign_call(file, "while it was loaded", [&] { plugin.fill(opened.contents); });
  } catch (const PluginError& error) {
    throw InputError(error.what());
  }
  return opened;
}

/// Returns the contents of a shared object or a program, read through the interface that it has.
OpenedPlugin opened(const std::string& file) {
  if (is_program(file)) {
    return {{{structure_of_program(file)}, {}, {}}, "a program of its own", "its author"};
  }
  const LoadingTime time;
  void* object = open(file);
  if (const void* entry = ::dlsym(object, kEntry)) {
    return filled_by(file, *static_cast<const Plugin*>(entry));
  }
  if (void* contenders = ::dlsym(object, kContenders)) {
    return {{structures_of(reinterpret_cast<decltype(&beambench_contenders)>(contenders)), {}, {}},
            fmt::format("by version {} of the C interface", BEAMBENCH_C_INTERFACE),
            "its author"};
  }
  refuse(file, fmt::format("is not a beambench plug-in: it defines neither '{}' nor '{}', the "
                           "function of the C interface; see harness/plugin/README.md",
                           kEntry, kContenders));
}

OpenedPlugin checked_plugin(const std::string& file) {
  try {
    OpenedPlugin plugin = opened(file);
    check_contents(plugin.contents);
    return plugin;
  } catch (const PluginError& error) {
    refuse(file, error.what());
  }
}

template <class Thing>
std::vector<std::string> names_of(const std::vector<Thing>& things, std::string Thing::*name) {
  std::vector<std::string> names;
  names.reserve(things.size());
  for (const Thing& thing : things) names.push_back(thing.*name);
  return names;
}

/// Calls `make` of the plug-in, and validates its scene.
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
        fmt::format("the plug-in {} made an invalid scene {}: {}", file, name, error.what()));
  }
  return scene;
}

scenes::SceneInfo guarded(scenes::SceneInfo info, Activity& activity) {
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

scenes::SceneReader guarded(scenes::SceneReader reader, Activity& activity) {
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
    thing = guarded(std::move(thing), activity);
  }
}

namespace fs = std::filesystem;

constexpr std::string_view kOption = "--plugin";
constexpr const char* kPluginsVariable = "BEAMBENCH_PLUGINS";

void add_once(std::vector<std::string>& files, std::string file) {
  if (std::ranges::find(files, file) == files.end()) files.push_back(std::move(file));
}

void add_folder(std::vector<std::string>& files, const fs::path& folder) {
  std::vector<std::string> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".so") found.push_back(entry.path().string());
  }
  std::ranges::sort(found);
  for (std::string& file : found) add_once(files, std::move(file));
}

void add_from_environment(std::vector<std::string>& files) {
  const char* text = std::getenv(kPluginsVariable);
  std::string_view rest = text == nullptr ? "" : text;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const std::string entry(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    std::error_code error;
    if (fs::is_directory(entry, error)) {
      add_folder(files, entry);
    } else if (!entry.empty()) {
      add_once(files, entry);
    }
  }
}

}  // namespace

void load_plugin(const std::string& file, Activity& activity) {
  activity.write(Activity::Line::kForeign, file, ": loading it");
  require_file(file);
  OpenedPlugin plugin = checked_plugin(file);
  PluginContents& contents = plugin.contents;
  activity.clear(Activity::Line::kForeign);

  all_loaded().push_back(
      {file, plugin.description, rays::fingerprint(read_input(file, kLargestFile)), plugin.compiler,
       plugin.instructions, plugin.optimized,
       names_of(contents.structures, &accel::StructureInfo::name),
       names_of(contents.scenes, &scenes::SceneInfo::name),
       names_of(contents.readers, &scenes::SceneReader::ending), !is_program(file)});
  recording() = &activity;
  adopt(contents.structures, file, activity);
  adopt(contents.scenes, file, activity);
  adopt(contents.readers, file, activity);
  accel::register_plugin_structures(std::move(contents.structures));
  scenes::register_plugin_scenes(std::move(contents.scenes), std::move(contents.readers));
}

Activity& activity_of_plugins() { return *recording(); }

std::span<const LoadedPlugin> loaded_plugins() { return all_loaded(); }

std::string program_call() { return call_with_plugins("beambench"); }

void set_program_name(std::string_view word) { program_name() = word; }

std::string program_call_here() { return call_with_plugins(program_name()); }

std::vector<std::string> program_words() {
  std::vector<std::string> words{"/proc/self/exe"};
  for (const LoadedPlugin& plugin : all_loaded()) {
    words.insert(words.end(), {"--plugin", plugin.file});
  }
  return words;
}

std::vector<std::string> take_requested_plugins(std::vector<std::string>& arguments) {
  std::vector<std::string> files;
  add_from_environment(files);
  std::vector<std::string> left;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument == "--") {
      left.insert(left.end(), arguments.begin() + static_cast<std::ptrdiff_t>(i), arguments.end());
      break;
    }
    if (argument.starts_with("--plugin=")) {
      add_once(files, argument.substr(std::string_view("--plugin=").size()));
    } else if (argument == kOption) {
      if (++i == arguments.size()) {
        throw InputError(
            "--plugin needs a file: the shared object that beambench_add_plugin built");
      }
      add_once(files, arguments[i]);
    } else {
      left.push_back(argument);
    }
  }
  arguments = std::move(left);
  return files;
}

}  // namespace beambench::plugin

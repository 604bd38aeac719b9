#pragma once
// Plug-ins: requested on the command line, loaded from their files, validated, and registered.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/plugin/activity.hpp"

namespace beambench::plugin {

/// A plug-in that was loaded.
struct LoadedPlugin {
  std::string file;  ///< as on the command line
  std::string description;
  std::uint64_t hash;  ///< fingerprint of the file
  std::string compiler;
  std::string instructions;
  bool optimized;
  std::vector<std::string> structures;  ///< their names
  std::vector<std::string> scenes;
  std::vector<std::string> readers;  ///< the endings of their files
};

/// Loads a plug-in (plugin.hpp) and adds what it provides to `registry()` and to the catalogue,
/// each with `origin` set; to be called before a structure or a scene is chosen. Refuses it by an
/// InputError that names the file: it cannot be loaded, is no plug-in, was built for another
/// version of the interface (the message says what changed), with other types or another C++
/// library, throws, or provides nothing or what check_contents refuses. Then nothing of it is
/// registered. `activity` outlives the program's use of it.
void load_plugin(const std::string& file, Activity& activity);

/// In the order in which they were loaded.
std::span<const LoadedPlugin> loaded_plugins();

/// How this program is called with its plug-ins, for commands that are kept in records, on whatever
/// machine they are pasted: `beambench` or `beambench --plugin ./libmine.so`.
std::string program_call();

/// The word that this program was called by, for `program_call_here`; `beambench` if never set.
void set_program_name(std::string_view word);

/// The same for commands to be pasted at once into the shell that the program was called from:
/// `build/release/bin/beambench --plugin ./libmine.so`.
std::string program_call_here();

/// Removes `--plugin FILE` and `--plugin=FILE` from a command line (the program's name first)
/// before a `--`, and returns the files, each once. Those of the environment variable
/// BEAMBENCH_PLUGINS come first: separated by colons, each a file, or a folder for all its `*.so`
/// sorted by name. Throws InputError where the option has no file.
std::vector<std::string> take_requested_plugins(std::vector<std::string>& arguments);

}  // namespace beambench::plugin

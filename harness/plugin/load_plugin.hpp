#pragma once
// Plug-ins: loaded from their files, looked over, and taken into the program.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "harness/plugin/activity.hpp"

namespace beambench {

/// A plug-in that was loaded.
struct LoadedPlugin {
  std::string file;  ///< as it was given
  std::string description;
  std::uint64_t hash;  ///< fingerprint of the file
  std::string compiler;
  std::string instructions;
  bool optimised;
  std::vector<std::string> structures;  ///< their names
  std::vector<std::string> scenes;
  std::vector<std::string> readers;  ///< the endings of their files
};

/// Loads a plug-in (plugin.hpp) and adds what it brings to `registry()` and to the catalogue, each
/// with `origin` set: for the time before a structure or a scene is chosen. Refuses it by an
/// InputError that names the file: it cannot be loaded, is no plug-in, was built for another
/// interface, with other types or another C++ library, throws, or brings nothing or what
/// check_contents refuses. Then nothing of it is taken in. `activity` outlives the program's use of
/// it.
void load_plugin(const std::string& file, Activity& activity);

/// In the order in which they were loaded.
std::span<const LoadedPlugin> loaded_plugins();

/// How this program is called with its plug-ins, for commands to be pasted into a shell:
/// `beambench` or `beambench --plugin ./libmine.so`.
std::string program_call();

}  // namespace beambench

#pragma once
// Plug-ins: requested on the command line, loaded from their files, validated, and registered.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/plugin/activity.hpp"

namespace beambench::plugin {

/// A loaded plug-in.
struct LoadedPlugin {
  std::string file;  ///< as given on the command line
  std::string description;
  std::uint64_t hash;        ///< fingerprint of the file
  std::string compiler;      ///< "its author" where the interface does not state it
  std::string instructions;  ///< empty where the interface does not state it
  bool optimized;
  std::vector<std::string> structures;  ///< their names
  std::vector<std::string> scenes;
  std::vector<std::string> readers;  ///< the endings of their files
  bool is_shared_object;             ///< false for a program, which has a process of its own
};

/// Loads a plug-in and adds its contents to `registry()` and to the catalogue, each with `origin`
/// set. A plug-in is a shared object with the C++ interface (plugin.hpp) or the C interface
/// (contender.h), or a program (program_contender.hpp): an executable file whose name does not
/// contain `.so`. Must be called before a structure or a scene is chosen. Throws InputError naming
/// the file if it cannot be loaded; is not a plug-in; was built for another version of the
/// interface (the message states the changes), with other types or with another C++ library;
/// throws; or provides nothing, or contents that `check_contents` refuses. In that case, none of
/// its contents are registered. `activity` must outlive the plug-in's use.
void load_plugin(const std::string& file, Activity& activity);

/// Returns the object in which the loaded plug-ins record their actions. At least one plug-in must
/// be loaded.
Activity& activity_of_plugins();

/// Returns the plug-ins in the order of loading.
std::span<const LoadedPlugin> loaded_plugins();

/// Returns the command for this program with its plug-ins, for use in records, on any machine:
/// `beambench` or `beambench --plugin ./libmine.so`.
std::string program_call();

/// Sets the name by which this program was called, for `program_call_here`; `beambench` by default.
void set_program_name(std::string_view word);

/// Returns the command for this program with its plug-ins, to be pasted into the shell from which
/// the program was called: `build/release/bin/beambench --plugin ./libmine.so`.
std::string program_call_here();

/// Returns this program and its plug-ins, as the first words of a command that another process
/// runs:
/// "/proc/self/exe", "--plugin", "./libmine.so".
std::vector<std::string> program_words();

/// Removes `--plugin FILE` and `--plugin=FILE` from a command line (the program's name first)
/// before a `--`, and returns the files, each once. The files of the environment variable
/// BEAMBENCH_PLUGINS come first. Its entries are separated by colons; each is a file, or a folder
/// that stands for all its `*.so` files, sorted by name. Throws InputError if the option has no
/// file.
std::vector<std::string> take_requested_plugins(std::vector<std::string>& arguments);

}  // namespace beambench::plugin

#pragma once
// The catalogue: scene names with parameters, and files, to scenes.

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/core/parameters.hpp"
#include "scenes/formats/nff/nff_reader.hpp"
#include "scenes/scene.hpp"

namespace beambench::scenes {

/// One generated scene of the catalogue.
struct SceneInfo {
  std::string name;
  std::string summary;  ///< one sentence
  std::vector<ParameterInfo> parameters;
  std::function<Scene(const Parameters&)> generate;
  std::string size_parameter{};  ///< the integer that it grows with; empty where none does that
  std::string origin{};          ///< the file of the plug-in that it comes from; empty: built in
};

/// A format of scene files that a plug-in reads.
struct SceneReader {
  std::string ending;   ///< of the files' names, in lower case, with its dot: `.xyz`
  std::string summary;  ///< one sentence
  /// Reads a file. What it noticed on the way goes to `warnings`. Throws InputError with file and
  /// line when the file is malformed.
  std::function<Scene(const std::filesystem::path& file, std::vector<std::string>& warnings)> read;
  std::string origin{};  ///< the file of the plug-in
};

/// All generated scenes, sorted by name: the built-in ones and those of plug-ins.
std::span<const SceneInfo> scene_catalogue();
/// The formats that plug-ins read, beside those that are built in (NFF and meshes).
std::span<const SceneReader> scene_readers();

/// The scene of the catalogue with that name; throws InputError naming the nearest and all of them.
const SceneInfo& find_scene(const std::string& name);

/// A scene by what the user typed: a catalogue name with parameters (`balls:n=4`), a registered
/// mesh (`mesh:dragon`), or a path to a mesh (by its ending, see mesh_endings()), to a file that a
/// plug-in reads (see scene_readers()) or an NFF file (anything else with a slash, or the ending
/// .nff). `Scene::name` is the canonical label of a
/// catalogue's scene, the text itself of all others. Throws InputError: unknown name (with the
/// nearest and all valid ones), parameter out of range, file missing or malformed. What a file's
/// reader noticed on the way is appended to `warnings` when given; the options are for files.
Scene load_scene(std::string_view spec, std::vector<std::string>* warnings = nullptr,
                 nff::NffOptions options = {});

}  // namespace beambench::scenes

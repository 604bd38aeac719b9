#pragma once
// The catalogue: scene names with parameters, and files, to scenes.

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/base/parameters.hpp"
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

/// How to read a file.
struct ReadOptions {
  bool strict = false;  ///< whatever would give a warning is an error
};

/// A format of scene files that is built in.
struct SceneFormat {
  /// Whether the format reads what the user typed, which it decides by the text alone.
  std::function<bool(std::string_view spec)> reads;
  /// Reads it, and appends what was skipped or repaired to `warnings`. Throws InputError with file
  /// and line when the file is malformed.
  std::function<Scene(std::string_view spec, ReadOptions options,
                      std::vector<std::string>& warnings)>
      read;
};

/// A format of scene files that a plug-in reads.
struct SceneReader {
  std::string ending;   ///< of the files' names, in lower case, with its dot: `.xyz`
  std::string summary;  ///< one sentence
  /// Reads a file, and appends what was skipped or repaired to `warnings`. Throws InputError with
  /// file and line when the file is malformed.
  std::function<Scene(const std::filesystem::path& file, std::vector<std::string>& warnings)> read;
  std::string origin{};  ///< the file of the plug-in
};

/// What the files of generators and formats register themselves with.
class Catalogue {
 public:
  void add(SceneInfo scene);
  /// The first of several formats that read a text gets it.
  void add_format(SceneFormat format);
  /// Its files are read by it rather than by a built-in format.
  void add_reader(SceneReader reader);

  std::span<const SceneInfo> scenes() const { return scenes_; }  ///< sorted by name
  std::span<const SceneReader> readers() const { return readers_; }
  std::span<const SceneFormat> formats() const { return formats_; }

 private:
  std::vector<SceneInfo> scenes_;
  std::vector<SceneReader> readers_;
  std::vector<SceneFormat> formats_;  // the readers among them
};

/// All generated scenes, sorted by name: the built-in ones and those of plug-ins.
std::span<const SceneInfo> scene_catalogue();
/// The formats that plug-ins read, beside those that are built in (NFF and meshes).
std::span<const SceneReader> scene_readers();

/// Registers what a plug-in brings, validated by the caller (harness/plugin/check_contents.hpp).
/// Ends the spans of `scene_catalogue()` and `scene_readers()`: call it before they are used.
void register_plugin_scenes(std::vector<SceneInfo> scenes, std::vector<SceneReader> readers);

/// The scene of the catalogue with that name; throws InputError naming the nearest and all of them.
const SceneInfo& find_scene(const std::string& name);

/// Whether the text is that of a file (or registered mesh) that a format reads.
bool is_scene_file(std::string_view spec);

/// A scene by what the user typed: a catalogue name with parameters (`balls:n=4`), a registered
/// mesh (`mesh:dragon`), or a path to a mesh (by its ending), to a file that a plug-in reads (see
/// scene_readers()) or an NFF file (anything else with a slash, or the ending .nff). `Scene::name`
/// is the canonical label of a catalogue's scene, the text as `name_of_path` shows it of all
/// others. Throws InputError: unknown name (with the nearest and all valid ones), parameter out of
/// range, file missing or malformed, a scene without primitives. What a file's reader skipped or
/// repaired is appended to `warnings` when given, a printable line each; the options are for files.
Scene load_scene(std::string_view spec, std::vector<std::string>* warnings = nullptr,
                 ReadOptions options = {});

}  // namespace beambench::scenes

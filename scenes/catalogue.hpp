#pragma once
// The catalogue, which turns scene names with parameters, and file paths, into scenes.

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/animation.hpp"
#include "scenes/base/parameters.hpp"
#include "scenes/scene.hpp"

namespace beambench::scenes {

/// One generated scene of the catalogue.
struct SceneInfo {
  std::string name;
  std::string summary;  ///< one sentence
  std::vector<ParameterInfo> parameters;
  /// May be null if `animate` is given: `Catalogue::add` then derives it from `animate`.
  std::function<Scene(const Parameters&)> generate{};
  std::string size_parameter{};  ///< the integer that scales the scene; may be empty
  std::string origin{};          ///< file of the plug-in that defines it; empty if built in
  /// Creates the scene and its frames. The scene then has the parameter `frames_parameter()`, the
  /// number of frames. Null if the scene is static.
  std::function<Animation(const Parameters&)> animate{};
};

/// Returns the parameter `frames` of moving scenes.
ParameterInfo frames_parameter();

/// Options for reading a file.
struct ReadOptions {
  bool strict = false;  ///< treat every warning as an error
};

/// A built-in format of scene files.
struct SceneFormat {
  /// Returns whether the format reads what the user typed, judging by the typed text alone.
  std::function<bool(std::string_view spec)> reads;
  /// Reads the file and its frames, and appends to `warnings` what was skipped or repaired. Throws
  /// InputError with file and line if the file is malformed.
  std::function<Animation(std::string_view spec, ReadOptions options,
                          std::vector<std::string>& warnings)>
      read;
};

/// A format of scene files that a plug-in reads.
struct SceneReader {
  std::string ending;   ///< ending of the file names, in lower case, with its dot: `.xyz`
  std::string summary;  ///< one sentence
  /// Reads a file, and appends to `warnings` what was skipped or repaired. Throws InputError with
  /// file and line when the file is malformed.
  std::function<Scene(const std::filesystem::path& file, std::vector<std::string>& warnings)> read;
  std::string origin{};  ///< the file of the plug-in
};

/// The registry of generators and formats.
class Catalogue {
 public:
  void add(SceneInfo scene);
  /// Adds a format. If several formats read the same text, the first one added is used.
  void add_format(SceneFormat format);
  /// Adds a plug-in's reader, which takes precedence over the built-in formats.
  void add_reader(SceneReader reader);

  std::span<const SceneInfo> scenes() const { return scenes_; }  ///< sorted by name
  std::span<const SceneReader> readers() const { return readers_; }
  std::span<const SceneFormat> formats() const { return formats_; }

 private:
  std::vector<SceneInfo> scenes_;
  std::vector<SceneReader> readers_;
  std::vector<SceneFormat> formats_;  // includes the readers
};

/// Returns all generated scenes, sorted by name: the built-in ones and those of plug-ins.
std::span<const SceneInfo> scene_catalogue();
/// Returns the formats that plug-ins read, in addition to the built-in ones (NFF and meshes).
std::span<const SceneReader> scene_readers();

/// Returns the parameter that every catalogue scene has in addition to its own: `perturb`, the seed
/// of `perturbed` (perturbed.hpp); 0, the default, leaves the scene as it is. With any other seed,
/// the scene is static.
const ParameterInfo& perturb_parameter();

/// Registers the scenes and readers of a plug-in, validated by the caller
/// (harness/plugin/check_contents.hpp). Invalidates the spans of `scene_catalogue()` and
/// `scene_readers()`, so call it before they are used.
void register_plugin_scenes(std::vector<SceneInfo> scenes, std::vector<SceneReader> readers);

/// Returns the catalogue scene with that name. Throws InputError with the nearest name and all
/// valid names.
const SceneInfo& find_scene(const std::string& name);

/// Returns whether the text names a file (or registered mesh) that a format reads.
bool is_scene_file(std::string_view spec);

/// Loads the scene that the user named: a catalogue name with parameters (`balls:n=4`), a
/// registered mesh (`mesh:dragon`), or a path to a mesh (by its ending), to a file that a plug-in
/// reads (see scene_readers()), or to an NFF file (with the ending .nff, or with a slash and no
/// ending). `Scene::name` is the canonical label of a catalogue scene; for all others it is the
/// text in the form of `name_of_path`. Throws InputError for an unknown name (with the nearest name
/// and all valid names), a parameter out of range, a missing or malformed file, or a scene without
/// primitives. Appends to `warnings`, if given, what the reader skipped or repaired, one printable
/// line each. The options apply to files.
Scene load_scene(std::string_view spec, std::vector<std::string>* warnings = nullptr,
                 ReadOptions options = {});

/// Loads a scene like `load_scene`, but with its frames.
Animation load_animation(std::string_view spec, std::vector<std::string>* warnings = nullptr,
                         ReadOptions options = {});

}  // namespace beambench::scenes

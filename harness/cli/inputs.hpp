#pragma once
// What several commands ask for: a scene, a camera, structures to put over it.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "accel/core/registry.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene.hpp"

namespace beambench::cli {

/// Loads a scene; what its file's reader noticed goes to stderr, or where the options are strict,
/// is refused. Throws as load_scene.
scenes::Scene open_scene(std::string_view spec, scenes::ReadOptions options = {});

/// What SCENE may be, for the help of every command.
inline constexpr const char* kSceneHelp =
    "Catalogue name, mesh:NAME, or path of an NFF or mesh file";
/// Adds SCENE, one and required.
void add_scene_option(CLI::App& command, std::string& scene);

/// Where the rays come from: one of the scene's cameras, or a view of the user's own.
struct ViewRequest {
  std::string camera;  ///< empty: the scene's first
  std::string from;    ///< X,Y,Z; empty, like the others: the camera's own
  std::string at;
  std::string up;
  std::optional<double> angle;  ///< degrees
};
/// Adds --camera.
void add_camera_option(CLI::App& command, ViewRequest& request);
/// The same, --from, --at, --up and --angle.
void add_view_options(CLI::App& command, ViewRequest& request);

/// What a camera of the user's own is called in pictures and records.
inline constexpr const char* kTypedCamera = "typed";

/// The camera that is asked for: one of the scene's, or where a part of it is typed, that camera
/// with this part replaced, named `kTypedCamera`. Throws InputError listing the scene's cameras for
/// an unknown name, and saying what is expected for a view that is none.
scenes::Camera choose_camera(const scenes::Scene& scene, const ViewRequest& request);

/// The one structure that is typed after `option`. Throws InputError when they are several.
accel::StructureChoice choose_one(std::string_view option, std::string_view text);

/// How an image is asked for.
struct ImageRequest {
  std::string resolution;  ///< empty: the camera's own
  ViewRequest view;
  int samples = 1;
};
/// Throws InputError for a wrong resolution, camera or number of samples.
rays::ImageOfRays choose_image(const scenes::Scene& scene, const ImageRequest& request);
accel::PrimaryRays choose_rays(const scenes::Scene& scene, const ImageRequest& request);
/// Adds --resolution and --samples.
void add_size_options(CLI::App& command, ImageRequest& request);
/// The same and the options of the view.
void add_image_options(CLI::App& command, ImageRequest& request);

/// The structures of a list as typed after --accel. Where `all` brought in `exhaustive` and the
/// scene is too large for it (kExhaustiveLimit), it is left out and `note` says so.
struct Contenders {
  std::vector<accel::StructureChoice> choices;
  std::string note;
};
Contenders choose_contenders(std::string_view list, const scenes::Scene& scene);
inline constexpr std::size_t kExhaustiveLimit = 20000;

}  // namespace beambench::cli

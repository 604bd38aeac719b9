#pragma once
// Options of several commands: scenes, cameras, images, structures, light; and renamed options.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/App.hpp>

#include "accel/core/registry.hpp"
#include "harness/base/messages.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/render/shadows.hpp"
#include "scenes/scene.hpp"

namespace beambench::cli {

using base::open_scene;

/// What SCENE may be, for the help of every command.
inline constexpr const char* kSceneHelp =
    "Catalogue name, mesh:NAME, or path of an NFF or mesh file";
/// Adds SCENE, one and required.
void add_scene_option(CLI::App& command, std::string& scene);

/// The camera: one of the scene's, or a view given by options.
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

/// The name of a camera that is given by options, in pictures and records.
inline constexpr const char* kTypedCamera = "typed";

/// The requested camera: one of the scene's, or where parts of it are given, that camera with these
/// parts replaced, named `kTypedCamera`. Throws InputError listing the scene's cameras for
/// an unknown name, and saying what is expected for a view that is none.
scenes::Camera choose_camera(const scenes::Scene& scene, const ViewRequest& request);

/// The structure that is given for `option`. Throws InputError when there are several.
accel::StructureChoice choose_one(std::string_view option, std::string_view text);

/// An image's options.
struct ImageRequest {
  std::string resolution;  ///< empty: the camera's own
  ViewRequest view;
  int samples = 1;
};
/// Throws InputError for a wrong resolution, camera or number of samples.
rays::ImageOfRays choose_image(const scenes::Scene& scene, const ImageRequest& request);
/// The resolution of the options; nothing where it is the camera's own.
std::optional<rays::Resolution> chosen_resolution(const ImageRequest& request);
/// Adds --resolution and --samples.
void add_size_options(CLI::App& command, ImageRequest& request);
/// The same and the options of the view.
void add_image_options(CLI::App& command, ImageRequest& request);

/// The structures given for --accel. Where `all` brought in `exhaustive` and the
/// scene is too large for it (kExhaustiveLimit), it is left out and `note` says so.
struct Contenders {
  std::vector<accel::StructureChoice> choices;
  std::string note;
};
Contenders choose_contenders(std::string_view list, const scenes::Scene& scene);
inline constexpr std::size_t kExhaustiveLimit = 20000;

/// How light is followed in pictures of the whole ray tracer.
struct WhittedRequest {
  std::string shadows = "rays";
  int max_depth = render::WhittedOptions{}.max_depth;
  double min_weight = 0.0;
  int threads = 0;  ///< see `accel::thread_count`
};
/// Adds --shadows, --depth and --min-weight.
void add_light_options(CLI::App& command, WhittedRequest& request);
/// The same and --threads.
void add_whitted_options(CLI::App& command, WhittedRequest& request);
/// Throws InputError for an unknown shadow method.
render::WhittedOptions whitted_options(const WhittedRequest& request);

/// `tetra-n-4-default-samet-max_level-5` of `tetra:n=4-default-samet:max_level=5`: a name that
/// file systems and shells take.
std::string file_stem(std::string title);
/// The same with the ending .png.
std::string picture_name(std::string title);

/// Replaces options by their new names where they were renamed, with a warning by `program` on
/// stderr.
void replace_renamed_options(std::string_view program, std::vector<std::string>& arguments);

}  // namespace beambench::cli

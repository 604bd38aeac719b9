#pragma once
// Options shared by several commands: scenes, cameras, images, structures, light; and renamed
// options.

#include <cstdint>
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

using base::open_animation;
using base::open_scene;

/// The description of SCENE in the help of every command.
inline constexpr const char* kSceneHelp =
    "Catalogue name, mesh:NAME, or path of an NFF or mesh file";
/// Adds SCENE as one required argument.
void add_scene_option(CLI::App& command, std::string& scene);
/// Throws InputError if a scene's name is that of a structure or of a kind of rays, as happens if a
/// list is separated by blanks instead of commas.
void refuse_structures_as_scenes(const std::vector<std::string>& scenes);
/// Adds --frame.
CLI::Option* add_frame_option(CLI::App& command, std::uint32_t& frame);

/// Adds --verbose.
void add_verbose_option(CLI::App& command, bool& verbose);

/// The seconds within which a plug-in must build a structure over a scene and finish all queries.
inline constexpr double kDefaultTimeout = 30.0;
/// Adds --timeout.
void add_timeout_option(CLI::App& command, double& seconds);

/// Returns the check for an option whose value must be a whole number, or any number, in [lower,
/// upper].
CLI::Validator whole_number_in(std::int64_t lower, std::int64_t upper);
CLI::Validator number_in(double lower, double upper);

/// The requested camera: one of the scene's, or a view specified by options.
struct ViewRequest {
  std::string camera;  ///< empty: the scene's first camera
  std::string from;    ///< X,Y,Z; if this or `at` or `up` is empty: the camera's
  std::string at;
  std::string up;
  std::optional<double> angle;  ///< degrees
};
/// Adds --camera.
void add_camera_option(CLI::App& command, ViewRequest& request);
/// Adds --camera, --from, --at, --up and --angle.
void add_view_options(CLI::App& command, ViewRequest& request);

/// The name, in pictures and records, of a camera specified by options.
inline constexpr const char* kTypedCamera = "typed";

/// Returns the requested camera: one of the scene's or, if parts of a view are given, that camera
/// with these parts replaced, named `kTypedCamera`. Throws InputError listing the scene's cameras
/// for an unknown name, and stating the expected form for an invalid view.
scenes::Camera choose_camera(const scenes::Scene& scene, const ViewRequest& request);

/// Returns the structure given for `option`. Throws InputError if several structures are given.
accel::StructureChoice choose_one(std::string_view option, std::string_view text);

/// The options of an image.
struct ImageRequest {
  std::string resolution;  ///< empty: that of the camera
  ViewRequest view;
  int samples = 1;
};
/// Returns the image. Throws InputError for an invalid resolution, camera or number of samples.
rays::ImageOfRays choose_image(const scenes::Scene& scene, const ImageRequest& request);
/// Returns the resolution of the options; nothing if it is the camera's own.
std::optional<rays::Resolution> chosen_resolution(const ImageRequest& request);
/// Adds --resolution and --samples.
void add_size_options(CLI::App& command, ImageRequest& request);
/// Adds --resolution, --samples and the options of the view.
void add_image_options(CLI::App& command, ImageRequest& request);

/// The structures given for --accel. If `all` includes `exhaustive` and the scene is too large for
/// it (kExhaustiveLimit), it is left out, with a message in `note`.
struct Contenders {
  std::vector<accel::StructureChoice> choices;
  std::string note;
};
Contenders choose_contenders(std::string_view list, const scenes::Scene& scene);
inline constexpr std::size_t kExhaustiveLimit = 20000;

/// The options for light in pictures of the whole ray tracer.
struct WhittedRequest {
  std::string shadows = "rays";
  int max_depth = render::WhittedOptions{}.max_depth;
  double min_weight = 0.0;
  int threads = 0;  ///< see `accel::thread_count`
};
/// Adds --shadows, --depth and --min-weight.
void add_light_options(CLI::App& command, WhittedRequest& request);
/// Adds the options of light and --threads.
void add_whitted_options(CLI::App& command, WhittedRequest& request);
/// Returns the options. Throws InputError for an unknown shadow method.
render::WhittedOptions whitted_options(const WhittedRequest& request);

/// Returns `tetra-n-4-default-samet-max_level-5` for `tetra:n=4-default-samet:max_level=5`: a name
/// that is safe for file systems and shells.
std::string file_stem(std::string title);
/// Returns the file stem with the extension .png.
std::string picture_name(std::string title);

/// Replaces renamed options by their new names, and warns on stderr in the name of `program`.
void replace_renamed_options(std::string_view program, std::vector<std::string>& arguments);

}  // namespace beambench::cli

#pragma once
// What several commands ask for: a scene, one of its cameras, structures to put over it.

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "accel/registry.hpp"
#include "harness/rays/question.hpp"
#include "scenes/nff_reader.hpp"
#include "scenes/scene.hpp"

namespace beambench {

/// Loads a scene; what its file's reader noticed goes to stderr, or where the options are strict,
/// is refused. Throws as load_scene.
Scene open_scene(std::string_view spec, NffOptions options = {});

/// The camera of that name, the first where the name is empty. Throws InputError listing the names.
const Camera& choose_camera(const Scene& scene, std::string_view name);

/// The one structure that is typed after `option`. Throws InputError when they are several.
StructureChoice choose_one(std::string_view option, std::string_view text);

/// How an image is asked for.
struct ImageRequest {
  std::string resolution;  ///< empty: the camera's own
  std::string camera;      ///< empty: the scene's first
  int samples = 1;
};
/// Throws InputError for a wrong resolution, camera or number of samples. The scene outlives it.
ImageOfRays choose_image(const Scene& scene, const ImageRequest& request);
PrimaryRays choose_rays(const Scene& scene, const ImageRequest& request);
/// Adds --resolution, --samples and --camera.
void add_image_options(CLI::App& command, ImageRequest& request);

/// The structures of a list as typed after --accel. Where `all` brought in `exhaustive` and the
/// scene is too large for it (kExhaustiveLimit), it is left out and `note` says so.
struct Contenders {
  std::vector<StructureChoice> choices;
  std::string note;
};
Contenders choose_contenders(std::string_view list, const Scene& scene);
inline constexpr std::size_t kExhaustiveLimit = 20000;

}  // namespace beambench

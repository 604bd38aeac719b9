#pragma once
// Registered meshes: `mesh:dragon`.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/formats/mesh/given_view.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"

namespace beambench::scenes::mesh {

/// The prefix that marks a scene name as a registered mesh.
inline constexpr std::string_view kMeshPrefix = "mesh:";

/// A mesh of the registry: the file NAME.json in the folder `registered` of `cache_folder()`,
/// `{"path": "...", "up": "y", "front": "z", "about": "...", "cameras": [{"name": "hall", "from":
/// [x, y, z], "at": [x, y, z], "up": [x, y, z], "angle": 60}], "lights": [[x, y, z]]}`. Only the
/// path is required; it is relative to that folder. Cameras and lights are in the mesh's
/// coordinates; a camera's `up` (by default that of the mesh) and `angle` (45) are optional. Other
/// keys are ignored. scripts/meshes adds entries, and users may add their own.
struct RegisteredMesh {
  std::string name;
  std::filesystem::path path;
  Orientation orientation;
  GivenView view;
  std::string about;  ///< one sentence; empty if there is none
};

/// Returns the sorted names of all registered meshes.
std::vector<std::string> registered_mesh_names();

/// Returns the registered mesh. Throws InputError for an unknown name, stating the known names and
/// how to get more meshes, and for a malformed entry, naming its file.
RegisteredMesh find_registered_mesh(std::string_view name);

}  // namespace beambench::scenes::mesh

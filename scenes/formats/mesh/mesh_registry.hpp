#pragma once
// Meshes that have a name: `mesh:dragon`.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/formats/mesh/given_view.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"

namespace beambench::scenes::mesh {

/// How the names of registered meshes begin where a scene is named.
inline constexpr std::string_view kMeshPrefix = "mesh:";

/// A mesh of the registry: the file NAME.json in the folder `registered` of `cache_folder()`,
/// `{"path": "...", "up": "y", "front": "z", "about": "...", "cameras": [{"name": "hall", "from":
/// [x, y, z], "at": [x, y, z], "up": [x, y, z], "angle": 60}], "lights": [[x, y, z]]}`. Only the
/// path is needed; it is relative to that folder. Cameras and lights are in the mesh's coordinates;
/// of a camera, `up` (if not given, that of the mesh) and `angle` (45) may be left out. Other keys
/// are skipped. scripts/meshes puts some there, users may add their own.
struct RegisteredMesh {
  std::string name;
  std::filesystem::path path;
  Orientation orientation;
  GivenView view;
  std::string about;  ///< one sentence; empty if there is none
};

/// The names of all of them, sorted.
std::vector<std::string> registered_mesh_names();

/// Throws InputError: an unknown name, naming those that are there and how to get more; a
/// malformed entry, naming its file.
RegisteredMesh find_registered_mesh(std::string_view name);

}  // namespace beambench::scenes::mesh

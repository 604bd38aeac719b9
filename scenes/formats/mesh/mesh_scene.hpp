#pragma once
// Scenes from mesh files.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/animation.hpp"
#include "scenes/formats/mesh/given_view.hpp"
#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"
#include "scenes/scene.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::mesh {

/// Adds cameras, lights and a background. The cameras are those given, then fitted cameras that
/// show these points (`three-quarter`, `front`, `side`, `top`) unless their names are taken. The
/// lights are those given, or else two on the side of the `three-quarter` camera.
void add_view(SceneBuilder& builder, std::span<const glm::vec3> points,
              const Orientation& orientation, const GivenView& given = {});

/// Makes a scene from a mesh: flat triangles in file order, with the view of `add_view`.
Scene mesh_scene(const TriangleMesh& mesh, const std::string& name, const Orientation& orientation,
                 const GivenView& given = {});

/// The mesh file to read, and the options.
struct MeshRequest {
  std::filesystem::path path;
  std::string name;  ///< of the scene
  Orientation orientation;
  bool strict = false;  ///< treat anything left out of the mesh as an error
  GivenView view = {};
};

/// Loads a mesh file with its frames, either from the cache (`meshes` in `cache_folder()`) or from
/// the file, in which case it is added to the cache. Warnings are appended to `warnings` if given,
/// as `file: message`. Throws InputError with the file's name if it cannot be read, is malformed or
/// has no triangles.
Animation load_mesh(const MeshRequest& request, std::vector<std::string>* warnings = nullptr);

}  // namespace beambench::scenes::mesh

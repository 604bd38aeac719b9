#pragma once
// Scenes from mesh files.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/camera.hpp"
#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"
#include "scenes/scene.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::mesh {

/// Fitted cameras that see these points (`three-quarter`, which is the default, `front`, `side`,
/// `top`), two lights on the side of the first of them, and a background.
void add_view(SceneBuilder& builder, std::span<const glm::vec3> points,
              const Orientation& orientation);
/// The same with cameras of the mesh's own, which come before the fitted ones, the first being the
/// default; lights of its own, if any, take the place of the two.
void add_view(SceneBuilder& builder, std::span<const glm::vec3> points,
              const Orientation& orientation, std::span<const Camera> own_cameras,
              std::span<const Light> own_lights);

/// A scene of a mesh: flat triangles in the order of the file, with the view of `add_view`.
Scene mesh_scene(const TriangleMesh& mesh, const std::string& name, const Orientation& orientation,
                 std::span<const Camera> cameras = {}, std::span<const Light> lights = {});

/// What to read, and how.
struct MeshRequest {
  std::filesystem::path path;
  std::string name;  ///< of the scene
  Orientation orientation;
  bool strict = false;  ///< what would be left out of the mesh is an error
};

/// Reads a mesh file, or takes what it held from the cache (`meshes` in `cache_folder()`), where it
/// is put when it was read. What was noticed is appended to `warnings` when given, as
/// `file: message`. Throws InputError with the file's name when it cannot be read, is malformed or
/// has no triangle.
Scene load_mesh(const MeshRequest& request, std::vector<std::string>* warnings = nullptr);

}  // namespace beambench::scenes::mesh

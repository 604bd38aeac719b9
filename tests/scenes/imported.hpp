#pragma once
// Meshes of files that are in memory.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/formats/mesh/mesh_import.hpp"
#include "scenes/formats/mesh/mesh_scene.hpp"
#include "scenes/scene.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::scenes {

/// Reads a file of the ending, known as `a.` and it.
inline mesh::ImportedMesh imported(const std::string& bytes, const std::string& ending) {
  return mesh::import_mesh(bytes, ending, "a." + ending);
}

/// The message with which the file is refused; "(nothing thrown)" where it is not.
inline std::string refusal(const std::string& bytes, const std::string& ending) {
  return thrown_message([&] { imported(bytes, ending); });
}

inline std::uint64_t imported_hash(const std::string& bytes, const std::string& ending) {
  return scene_hash(mesh::mesh_scene(imported(bytes, ending).mesh, "a", {}));
}

/// The corners of each triangle.
inline std::vector<std::array<glm::vec3, 3>> triangles_of(const mesh::ImportedMesh& imported) {
  std::vector<std::array<glm::vec3, 3>> triangles;
  for (const auto& [a, b, c] : imported.mesh.triangles) {
    triangles.push_back(
        {imported.mesh.vertices[a], imported.mesh.vertices[b], imported.mesh.vertices[c]});
  }
  return triangles;
}

}  // namespace beambench::scenes

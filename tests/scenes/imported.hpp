#pragma once
// Imports mesh files in memory.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/formats/mesh/mesh_import.hpp"
#include "scenes/formats/mesh/mesh_scene.hpp"
#include "scenes/scene.hpp"
#include "tests/scenes/mesh_files.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::scenes {

/// Reads a file of the given ending, under the name `a.` and that ending.
inline mesh::ImportedMesh imported(const std::string& bytes, const std::string& ending) {
  return mesh::import_mesh(bytes, ending, "a." + ending);
}

/// Returns the message with which the file is refused; "(nothing thrown)" if it is accepted.
inline std::string refusal(const std::string& bytes, const std::string& ending) {
  return thrown_message([&] { imported(bytes, ending); });
}

inline std::uint64_t imported_hash(const std::string& bytes, const std::string& ending) {
  return scene_hash(mesh::mesh_scene(imported(bytes, ending).mesh, "a", {}));
}

/// Returns the hash of `tetrahedron_ply`.
inline std::uint64_t tetrahedron_hash() { return imported_hash(tetrahedron_ply(), "ply"); }

/// Returns the corners of each triangle.
inline std::vector<std::array<glm::vec3, 3>> triangles_of(const mesh::ImportedMesh& imported) {
  std::vector<std::array<glm::vec3, 3>> triangles;
  for (const auto& [a, b, c] : imported.mesh.triangles) {
    triangles.push_back(
        {imported.mesh.vertices[a], imported.mesh.vertices[b], imported.mesh.vertices[c]});
  }
  return triangles;
}

}  // namespace beambench::scenes

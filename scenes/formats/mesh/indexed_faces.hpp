#pragma once
// Faces over numbered vertices, as in PLY and OFF.

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/formats/mesh/mesh.hpp"

namespace beambench::scenes::mesh {

struct IndexedFaces {
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> corners;  ///< vertex indices of all faces, face by face
  std::vector<std::uint32_t> sizes;    ///< the number of corners of each face
};

/// Returns the mesh with these faces, of unpainted clay. A face of one or two vertices is a point
/// or a line and is left out with a warning, as in OBJ files; a face without vertices is ignored.
/// Throws like `MeshCollector` and `collected_mesh`.
ImportedMesh mesh_of(IndexedFaces&& faces);

}  // namespace beambench::scenes::mesh

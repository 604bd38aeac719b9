#pragma once
// Properties of every mesh that an importer accepts.

#include <string>

#include "scenes/formats/mesh/mesh.hpp"
#include "scenes/formats/mesh/mesh_file.hpp"
#include "scenes/formats/mesh/mesh_scene.hpp"
#include "tests/fuzz/target.hpp"

namespace beambench::fuzz {

/// Checks that the mesh becomes a scene or is refused, and that the cache returns the same mesh.
inline void check_imported(const scenes::mesh::ImportedMesh& imported) {
  const std::string bytes = encode(imported);
  require(encode(scenes::mesh::decode(bytes)) == bytes, "the cache returns a different mesh");
  accepted([&] {
    return mesh_scene(imported.mesh, "input", scenes::mesh::Orientation{},
                      {imported.cameras, imported.lights});
  });
}

}  // namespace beambench::fuzz

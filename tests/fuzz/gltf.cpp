// glTF, text and binary: an input that names `self.bin` is also its own buffer.

#include <string>

#include "scenes/formats/mesh/mesh_import.hpp"
#include "scenes/formats/mesh/mesh_motion.hpp"
#include "tests/fuzz/imported_mesh.hpp"
#include "tests/fuzz/scratch_folder.hpp"
#include "tests/fuzz/target.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace beambench;
  static const fuzz::ScratchFolder folder;
  const std::string_view bytes = fuzz::text_of(data, size);
  if (bytes.find("self.bin") != std::string_view::npos) folder.write("self.bin", bytes);
  const std::string ending = bytes.starts_with("glTF") ? "glb" : "gltf";
  const auto imported = fuzz::accepted([&] {
    return scenes::mesh::import_mesh(bytes, ending, folder.path() / ("input." + ending));
  });
  if (!imported) return 0;
  fuzz::check_imported(*imported);
  const scenes::mesh::MeshMotion& motion = imported->motion;
  if (motion.moves()) {
    const auto& vertices = imported->mesh.vertices;
    fuzz::require(vertices_in(motion, 0, vertices) == vertices, "frame 0 is not the mesh");
    vertices_in(motion, motion.frames - 1, vertices);
  }
  return 0;
}

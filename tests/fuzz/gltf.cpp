// glTF, as text and binary: an input that names `self.bin` is its own buffer.

#include <string>

#include "scenes/formats/mesh/mesh_import.hpp"
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
  if (imported) fuzz::check_imported(*imported);
  return 0;
}

// OBJ and its material libraries: an input that names `self.mtl` is also its own library.

#include "scenes/formats/mesh/mesh_import.hpp"
#include "tests/fuzz/imported_mesh.hpp"
#include "tests/fuzz/scratch_folder.hpp"
#include "tests/fuzz/target.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace beambench;
  static const fuzz::ScratchFolder folder;
  const std::string_view text = fuzz::text_of(data, size);
  if (text.find("self.mtl") != std::string_view::npos) folder.write("self.mtl", text);
  const auto imported = fuzz::accepted(
      [&] { return scenes::mesh::import_mesh(text, "obj", folder.path() / "input.obj"); });
  if (imported) fuzz::check_imported(*imported);
  return 0;
}

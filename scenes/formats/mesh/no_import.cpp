// Mesh import in a build without Assimp: there is none.

#include <fmt/format.h>

#include "scenes/core/error.hpp"
#include "scenes/formats/mesh/mesh_import.hpp"

namespace beambench::scenes::mesh {

std::uint32_t importer_version() { return 0; }

ImportedMesh import_mesh(std::string_view, const std::string&, const std::filesystem::path& path) {
  throw InputError(fmt::format(
      "{}: this build of beambench reads no meshes, because Assimp was missing when it was built; "
      "install libassimp-dev, configure afresh and build again (scripts/setup does both)",
      path.string()));
}

}  // namespace beambench::scenes::mesh

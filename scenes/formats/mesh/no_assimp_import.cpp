// Replaces assimp_import.cpp in a build without Assimp.

#include "scenes/formats/mesh/importers.hpp"

namespace beambench::scenes::mesh {

Importer assimp_importer() {
  return {
      "",
      [](std::string_view, const std::string&, const std::filesystem::path& path) -> ImportedMesh {
        refuse_missing_library(path, "Assimp", "libassimp-dev");
      }};
}

}  // namespace beambench::scenes::mesh

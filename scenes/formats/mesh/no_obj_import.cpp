// Stands for obj_import.cpp in a build without tinyobjloader.

#include "scenes/formats/mesh/importers.hpp"

namespace beambench::scenes::mesh {

Importer obj_importer() {
  return {
      "",
      [](std::string_view, const std::string&, const std::filesystem::path& path) -> ImportedMesh {
        refuse_missing_library(path, "tinyobjloader", "libtinyobjloader-dev");
      }};
}

}  // namespace beambench::scenes::mesh

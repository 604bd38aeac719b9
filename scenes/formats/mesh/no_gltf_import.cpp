// Replaces gltf_import.cpp in a build without tinygltf.

#include "scenes/formats/mesh/importers.hpp"

namespace beambench::scenes::mesh {

Importer gltf_importer() {
  return {
      "",
      [](std::string_view, const std::string&, const std::filesystem::path& path) -> ImportedMesh {
        refuse_missing_library(path, "tinygltf", "libtinygltf-dev");
      }};
}

}  // namespace beambench::scenes::mesh

#pragma once
// The contents of an OBJ file.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/formats/mesh/obj_lines.hpp"

namespace beambench::scenes::mesh {

struct ObjFile {
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> corners;     ///< corners of all faces: indices into vertices
  std::vector<std::uint32_t> face_sizes;  ///< the number of corners of each face
  /// The materials of `usemtl`, each with the first face that it applies to.
  std::vector<std::pair<std::size_t, std::string>> materials;
  std::vector<std::string> libraries;  ///< the text after each `mtllib`
  std::size_t points_and_lines = 0;
  std::size_t free_forms = 0;  ///< curves and surfaces
  UnknownLines unknown;
};

/// Reads the statements of an OBJ text. Throws InputError with the line, but without the file's
/// name, if the number of a vertex's numbers is not 3 to 7 (a weight or a color may follow the
/// coordinates), if a coordinate is not finite, or if a face refers to a vertex that is not in the
/// file.
ObjFile read_obj(std::string_view text);

}  // namespace beambench::scenes::mesh

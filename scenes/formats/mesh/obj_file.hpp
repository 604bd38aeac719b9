#pragma once
// What an OBJ file holds.

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
  std::vector<std::uint32_t> corners;     ///< of all faces: indices into vertices
  std::vector<std::uint32_t> face_sizes;  ///< how many of the corners each face has
  /// The materials of `usemtl`, each from a face on.
  std::vector<std::pair<std::size_t, std::string>> materials;
  std::vector<std::string> libraries;  ///< what follows each `mtllib`
  std::size_t points_and_lines = 0;
  std::size_t free_forms = 0;  ///< curves and surfaces
  UnknownLines unknown;
};

/// Reads the statements of a text. Throws InputError, without the file's name, naming the line,
/// when a vertex has other than 3 to 7 numbers (a weight or a color may follow the coordinates) or
/// a coordinate that is not finite, or when a face has a corner that is not a vertex of the file.
ObjFile read_obj(std::string_view text);

}  // namespace beambench::scenes::mesh

// PLY files, whose header `ply_header.hpp` describes. Following Turk's description and the files of
// the Stanford repository, these rows are read:
//
// - `vertex`, with the numbers x, y and z of any type, each rounded to float once; `face`, with the
//   list `vertex_indices` or `vertex_index`, with the indices of its corners in order, from 0;
//   `tristrips`, with a list of the same name: each corner from the third on forms a triangle with
//   the two before it, every second triangle has its winding reversed, and -1 starts another strip.
//   Any integer type is accepted, as is a floating-point type if its values are whole.
// - Elements may be in any order. All other properties and elements (normals, colors, edges,
//   cameras, materials) are skipped.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "scenes/base/error.hpp"
#include "scenes/formats/mesh/importers.hpp"
#include "scenes/formats/mesh/indexed_faces.hpp"
#include "scenes/formats/mesh/ply_header.hpp"
#include "scenes/formats/mesh/ply_rows.hpp"
#include "scenes/formats/mesh/text_lines.hpp"

namespace beambench::scenes::mesh {
namespace {

constexpr std::int64_t kNextStrip = -1;

bool is_vertex_list(const PlyProperty& property) {
  return property.name == "vertex_indices" || property.name == "vertex_index";
}

bool has_faces(const PlyElement& element) {
  return element.name == "face" || element.name == "tristrips";
}

[[noreturn]] void refuse_property(const PlyElement& element, std::string_view why) {
  throw InputError(
      fmt::format("its header declares the element '{}' {}; export it again", element.name, why));
}

/// Returns the axis of which the property is the coordinate; 3 for other properties.
glm::length_t axis_of(const PlyProperty& property) {
  const bool is_axis =
      property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z';
  return is_axis ? property.name[0] - 'x' : 3;
}

void require_coordinates(const PlyElement& vertex) {
  std::array<bool, 4> found{};
  for (const PlyProperty& property : vertex.properties) {
    const glm::length_t axis = axis_of(property);
    found[static_cast<std::size_t>(axis)] = true;
    if (axis < 3 && property.length_type) {
      refuse_property(vertex, fmt::format("with a list '{}' instead of a number", property.name));
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!found[axis]) refuse_property(vertex, fmt::format("without '{}'", "xyz"[axis]));
  }
}

void require_vertex_list(const PlyElement& element) {
  std::size_t lists = 0;
  for (const PlyProperty& property : element.properties) {
    if (!is_vertex_list(property)) continue;
    ++lists;
    if (!property.length_type) {
      refuse_property(element, fmt::format("with '{}' that is not a list", property.name));
    }
  }
  if (lists != 1) {
    refuse_property(element, fmt::format("with {} lists named 'vertex_indices' or "
                                         "'vertex_index', but one is needed",
                                         lists));
  }
}

/// Returns the declared number of vertices. Throws unless the header declares a mesh.
std::uint64_t require_ply_mesh(const PlyHeader& header) {
  std::uint64_t vertices = 0;
  bool any_face = false;
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex") vertices = element.count;
    if (has_faces(element)) any_face = any_face || element.count > 0;
  }
  if (!any_face) {
    throw InputError(
        fmt::format("its header declares {} but no faces, and rays cannot hit a point cloud; "
                    "reconstruct its surface, or export the mesh with its faces",
                    counted(vertices, "vertex", "vertices")));
  }
  for (const PlyElement& element : header.elements) {
    if (element.count == 0) continue;
    if (element.name == "vertex") require_coordinates(element);
    if (has_faces(element)) require_vertex_list(element);
  }
  return vertices;
}

/// Reads the rows of a file. `Rows` is one of the classes of ply_rows.hpp.
template <typename Rows>
class PlyBody {
 public:
  PlyBody(Rows rows, std::uint64_t vertices) : rows_(std::move(rows)), vertices_(vertices) {}

  IndexedFaces read(const PlyHeader& header) && {
    for (const PlyElement& element : header.elements) read_element(element);
    rows_.finish();
    return std::move(faces_);
  }

 private:
  void read_element(const PlyElement& element) {
    reserve(element);
    for (std::uint64_t row = 0; row < element.count; ++row) {
      if (!rows_.begin(element, row)) {
        throw InputError(
            fmt::format("its header declares {} of the element '{}', but after {} the file ends: "
                        "it is cut off, or its header is invalid; get it again",
                        element.count, element.name, row));
      }
      if (element.name == "vertex") {
        read_vertex(element);
      } else {
        for (const PlyProperty& property : element.properties) read_property(element, property);
      }
      rows_.end();
    }
  }

  /// Reserves memory for at most the rows that the rest of the file can hold.
  void reserve(const PlyElement& element) {
    if (element.count == 0) return;
    const std::size_t count =
        std::min<std::uint64_t>(element.count, rows_.at_most(element.properties.size()));
    if (element.name == "vertex") faces_.vertices.reserve(count);
    if (element.name == "face") {
      faces_.sizes.reserve(faces_.sizes.size() + count);
      faces_.corners.reserve(faces_.corners.size() + 3 * count);
    }
  }

  void read_vertex(const PlyElement& element) {
    glm::vec3 place{};
    for (const PlyProperty& property : element.properties) {
      const glm::length_t axis = axis_of(property);
      if (axis < 3) {
        place[axis] = static_cast<float>(rows_.number(property.type));
      } else {
        skip(property);
      }
    }
    faces_.vertices.push_back(place);
  }

  void read_property(const PlyElement& element, const PlyProperty& property) {
    if (!has_faces(element) || !is_vertex_list(property)) {
      skip(property);
    } else if (element.name == "face") {
      read_face(property);
    } else {
      read_strips(property);
    }
  }

  void skip(const PlyProperty& property) {
    rows_.skip(property.type, property.length_type ? length(property) : 1);
  }

  std::uint64_t length(const PlyProperty& list) {
    const double number = rows_.number(*list.length_type);
    if (number < 0.0) rows_.refuse(fmt::format("a list has the length {}", number));
    return static_cast<std::uint64_t>(number);
  }

  void read_face(const PlyProperty& list) {
    const std::uint64_t corners = length(list);
    for (std::uint64_t i = 0; i < corners; ++i) {
      faces_.corners.push_back(vertex(index(list.type)));
    }
    faces_.sizes.push_back(static_cast<std::uint32_t>(corners));  // no length type is wider
  }

  void read_strips(const PlyProperty& list) {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    std::uint64_t taken = 0;  // of the strip
    for (std::uint64_t left = length(list); left > 0; --left) {
      const std::int64_t number = index(list.type);
      if (number == kNextStrip) {
        taken = 0;
        continue;
      }
      const std::uint32_t third = vertex(number);
      if (taken >= 2) add_triangle(taken % 2 == 0, first, second, third);
      first = second;
      second = third;
      ++taken;
    }
  }

  void add_triangle(bool even, std::uint32_t first, std::uint32_t second, std::uint32_t third) {
    if (!even) std::swap(first, second);
    faces_.corners.insert(faces_.corners.end(), {first, second, third});
    faces_.sizes.push_back(3);
  }

  /// Takes a number from a list; it must be whole.
  std::int64_t index(PlyType type) {
    const double number = rows_.number(type);
    constexpr double kLargest = 0x1p53;
    if (!(std::abs(number) <= kLargest) || number != std::floor(number)) {
      rows_.refuse(fmt::format("'{}' is not a vertex index", number));
    }
    return static_cast<std::int64_t>(number);
  }

  std::uint32_t vertex(std::int64_t index) {
    constexpr std::int64_t kLargest = std::numeric_limits<std::uint32_t>::max();
    if (index < 0 || index > kLargest || static_cast<std::uint64_t>(index) >= vertices_) {
      rows_.refuse(fmt::format("it refers to vertex {}, but there are only {}, counted from 0",
                               index, vertices_));
    }
    return static_cast<std::uint32_t>(index);
  }

  Rows rows_;
  std::uint64_t vertices_;
  IndexedFaces faces_;
};

ImportedMesh read_ply(std::string_view bytes) {
  TextLines lines(bytes);
  const PlyHeader header = take_ply_header(lines);
  const std::uint64_t vertices = require_ply_mesh(header);
  if (header.encoding == PlyHeader::Encoding::kText) {
    return mesh_of(PlyBody(PlyTextRows(lines), vertices).read(header));
  }
  const PlyBinaryRows rows(bytes, lines.text_after(), header.encoding);
  return mesh_of(PlyBody(rows, vertices).read(header));
}

/// The version of this importer; increment it whenever the format is read differently.
constexpr int kPlyVersion = 1;

}  // namespace

Importer ply_importer() {
  return {fmt::format("ply-{}", kPlyVersion),
          [](std::string_view bytes, const std::string&, const std::filesystem::path& path) {
            return with_file_name(path, bytes, read_ply);
          }};
}

}  // namespace beambench::scenes::mesh

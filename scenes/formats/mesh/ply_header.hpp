#pragma once
// The header of PLY files.
//
// The rules are those of Greg Turk, "The PLY Polygon File Format" (1994), complemented by his ply.c
// and the files of the Stanford 3D Scanning Repository:
//
// - The first line is `ply`, the last one `end_header`. Between them is one of `format ascii 1.0`,
//   `format binary_little_endian 1.0` and `format binary_big_endian 1.0`.
// - `element NAME COUNT` declares rows; `property TYPE NAME` declares a number in each row of the
//   preceding element; `property list TYPE TYPE NAME` declares a list: its length, of the first
// type, followed by that many numbers of the second type.
// - Lines that begin with `comment` or `obj_info` are ignored. Words are separated by any blanks.
// - The rows follow the header, element by element in the order of the header: one per line, or in
//   binary without separators.

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "scenes/formats/mesh/text_lines.hpp"

namespace beambench::scenes::mesh {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

/// Returns the size of a number of the type in binary, in bytes.
std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string_view name;
  PlyType type = PlyType::kFloat32;    ///< of the number, or of each number in the list
  std::optional<PlyType> length_type;  ///< of a list
};

struct PlyElement {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  enum class Encoding { kText, kLittleEndian, kBigEndian };

  Encoding encoding = Encoding::kText;
  std::vector<PlyElement> elements;
};

/// Takes the lines of the header, up to `end_header`. Its names are views of the text. Throws
/// InputError with the line if the rules above are violated, if an element or a property is
/// declared twice, or if an element has rows but no properties: a short file could declare any
/// number of such rows.
PlyHeader take_ply_header(TextLines& lines);

}  // namespace beambench::scenes::mesh

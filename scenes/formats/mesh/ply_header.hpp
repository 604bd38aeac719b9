#pragma once
// The header of PLY files.
//
// The rules, by Greg Turk, "The PLY Polygon File Format" (1994), which his ply.c and the files of
// the Stanford 3D Scanning Repository complete:
//
// - The first line is `ply`, the last one `end_header`. `format ascii 1.0`,
//   `format binary_little_endian 1.0` or `format binary_big_endian 1.0` stands once between them.
// - `element NAME COUNT` declares rows, `property TYPE NAME` a number in each row of the element
//   before it, `property list TYPE TYPE NAME` a list: its length, of the first type, and as many
//   numbers of the second.
// - `comment` and `obj_info` begin lines without meaning. Any blanks may stand between words.
// - After the header stand the rows, element by element in the order of the header: each on a line,
//   or in binary without anything between them.

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
  PlyType type = PlyType::kFloat32;    ///< of the number, or of each in the list
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
/// declared twice, and for rows without a property, of which a short file could declare any number.
PlyHeader take_ply_header(TextLines& lines);

}  // namespace beambench::scenes::mesh

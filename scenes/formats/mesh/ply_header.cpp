#include "scenes/formats/mesh/ply_header.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "scenes/base/decimal.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::scenes::mesh {
namespace {

PlyType take_type(TextLines& lines) {
  using enum PlyType;
  constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes = {{
      {"char", kInt8},
      {"int8", kInt8},
      {"uchar", kUint8},
      {"uint8", kUint8},
      {"short", kInt16},
      {"int16", kInt16},
      {"ushort", kUint16},
      {"uint16", kUint16},
      {"int", kInt32},
      {"int32", kInt32},
      {"uint", kUint32},
      {"uint32", kUint32},
      {"float", kFloat32},
      {"float32", kFloat32},
      {"double", kFloat64},
      {"float64", kFloat64},
  }};
  const std::string_view word = lines.word();
  const auto* const found = std::find_if(kTypes.begin(), kTypes.end(),
                                         [&](const auto& type) { return type.first == word; });
  if (found != kTypes.end()) return found->second;
  lines.refuse(
      fmt::format("'{}' is not a property type, such as uchar, int or float", excerpt(word)));
}

std::string_view take_name(TextLines& lines, std::string_view what) {
  const std::string_view name = lines.word();
  if (name.empty()) lines.refuse(fmt::format("the {} has no name", what));
  return name;
}

void require_end_of_line(TextLines& lines) {
  const std::string_view word = lines.word();
  if (!word.empty()) {
    lines.refuse(fmt::format("'{}' follows where the line should end", excerpt(word)));
  }
}

/// Adds a name to the set; refuses duplicates.
void require_new(std::string_view name, std::set<std::string_view>& names, std::string_view what,
                 const TextLines& lines) {
  if (names.insert(name).second) return;
  lines.refuse(fmt::format("the {} '{}' is declared twice", what, excerpt(name)));
}

PlyHeader::Encoding take_encoding(TextLines& lines) {
  using enum PlyHeader::Encoding;
  constexpr std::array<std::pair<std::string_view, PlyHeader::Encoding>, 3> kEncodings = {
      {{"ascii", kText},
       {"binary_little_endian", kLittleEndian},
       {"binary_big_endian", kBigEndian}}};
  const std::string_view word = lines.word();
  const std::string_view version = lines.word();
  for (const auto& [name, encoding] : kEncodings) {
    if (word == name && version == "1.0") return encoding;
  }
  lines.refuse(
      fmt::format("the format is '{} {}', but must be ascii, binary_little_endian or "
                  "binary_big_endian, each with 1.0",
                  excerpt(word), excerpt(version)));
}

PlyElement take_element(TextLines& lines) {
  PlyElement element;
  element.name = take_name(lines, "element");
  const std::string_view word = lines.word();
  const auto count = integer_of(word);
  if (!count || *count < 0) {
    lines.refuse(fmt::format("'{}' is not a number of rows for the element '{}'", excerpt(word),
                             excerpt(element.name)));
  }
  element.count = static_cast<std::uint64_t>(*count);
  return element;
}

/// Takes `float x`, or `list uchar int vertex_indices`.
PlyProperty take_property(TextLines& lines) {
  PlyProperty property;
  TextLines after_list = lines;
  if (after_list.word() == "list") {
    lines = after_list;
    property.length_type = take_type(lines);
    if (*property.length_type >= PlyType::kFloat32) {
      lines.refuse("the length of a list has a type with fractions, but must have an integer type");
    }
  }
  property.type = take_type(lines);
  property.name = take_name(lines, "property");
  return property;
}

void require_properties(const PlyHeader& header, const TextLines& lines) {
  for (const PlyElement& element : header.elements) {
    if (element.count == 0 || !element.properties.empty()) continue;
    lines.refuse(fmt::format("the header declares {} of the element '{}', but no properties",
                             element.count, excerpt(element.name)));
  }
}

}  // namespace

std::size_t size_of(PlyType type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

PlyHeader take_ply_header(TextLines& lines) {
  if (!lines.next() || lines.word() != "ply") lines.refuse("the file does not begin with 'ply'");
  require_end_of_line(lines);
  PlyHeader header;
  std::optional<PlyHeader::Encoding> encoding;
  std::set<std::string_view> elements;
  std::set<std::string_view> properties;  // of the last element
  while (lines.next()) {
    const std::string_view word = lines.word();
    if (word.empty() || word == "comment" || word == "obj_info") continue;
    if (word == "format") {
      if (encoding) lines.refuse("the format is declared twice");
      encoding = take_encoding(lines);
    } else if (word == "element") {
      PlyElement element = take_element(lines);
      require_new(element.name, elements, "element", lines);
      properties.clear();
      header.elements.push_back(std::move(element));
    } else if (word == "property") {
      if (header.elements.empty()) lines.refuse("a property precedes the first element");
      const PlyProperty property = take_property(lines);
      require_new(property.name, properties, "property", lines);
      header.elements.back().properties.push_back(property);
    } else if (word == "end_header") {
      require_end_of_line(lines);
      if (!encoding) lines.refuse("the header ends without the line 'format'");
      header.encoding = *encoding;
      require_properties(header, lines);
      return header;
    } else {
      lines.refuse(fmt::format("'{}' is not a header keyword", excerpt(word)));
    }
    require_end_of_line(lines);
  }
  lines.refuse("the file ends before 'end_header'");
}

}  // namespace beambench::scenes::mesh

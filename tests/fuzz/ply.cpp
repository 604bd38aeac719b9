// PLY files: the input itself, and a valid file whose mesh, encoding and layout are drawn from it.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "scenes/formats/mesh/mesh_import.hpp"
#include "tests/fuzz/drawn_mesh.hpp"
#include "tests/fuzz/imported_mesh.hpp"
#include "tests/fuzz/target.hpp"
#include "tests/fuzz/written_text.hpp"
#include "tests/ply_file.hpp"

namespace {

using namespace beambench;
using fuzz::Draw;
using tests::PlyNumber;
using tests::PlyRow;

constexpr std::array<std::string_view, 12> kIntegers = {"char",  "int8",  "uchar",  "uint8",
                                                        "short", "int16", "ushort", "uint16",
                                                        "int",   "int32", "uint",   "uint32"};
constexpr std::array<std::string_view, 16> kTypes = {
    "char", "int8",  "uchar", "uint8",  "short", "int16",   "ushort", "uint16",
    "int",  "int32", "uint",  "uint32", "float", "float32", "double", "float64"};
/// Types that can hold -1.
constexpr std::array<std::string_view, 10> kSigned = {
    "char", "int8", "short", "int16", "int", "int32", "float", "float32", "double", "float64"};

/// An element of a file: its lines in the header, and its rows.
struct Element {
  std::string name;
  std::vector<std::string> properties;
  std::vector<PlyRow> rows;
};

bool is_real(std::string_view type) { return type.starts_with("float") || type == "double"; }

/// Draws a number of a type, and the coordinate that it becomes.
std::pair<PlyNumber, float> drawn_number(Draw& draw, std::string_view type) {
  if (type == "double" || type == "float64") {
    const double value = fuzz::drawn_double(draw);
    constexpr std::array<std::string_view, 3> kForms = {"{}", "{:.16e}", "{:.17G}"};
    std::string text = draw.once_in(4) ? fuzz::exact_text(value)
                                       : fmt::format(fmt::runtime(draw.of(kForms)), value);
    return {{type, value, std::move(text)}, static_cast<float>(value)};
  }
  if (is_real(type)) {
    fuzz::DrawnNumber number = fuzz::drawn_decimal(draw);
    const float expected = number.expected;
    return {{type, expected, std::move(number.text)}, expected};
  }
  const bool is_signed = type[0] != 'u';
  const bool is_byte = type.find("char") != std::string_view::npos || type.ends_with("t8");
  const bool is_short = type.find("short") != std::string_view::npos || type.ends_with("16");
  const std::uint32_t limit = is_byte ? 128U : is_short ? 32768U : 1'000'000'000U;
  const double size = draw.bits() % limit;
  const double value = is_signed && draw.once_in(2) ? -size : size;
  return {{type, value}, static_cast<float>(value)};
}

void put_number(Draw& draw, PlyRow& row, std::string_view type) {
  row.push_back(drawn_number(draw, type).first);
}

/// A property that is not used: a number or a list.
struct Extra {
  std::string_view length_type;  ///< empty: a number
  std::string_view type;
};

std::vector<Extra> drawn_extras(Draw& draw) {
  std::vector<Extra> extras(draw.once_in(2) ? 0 : draw.below(3));
  for (Extra& extra : extras) {
    extra = {draw.once_in(2) ? std::string_view() : draw.of(kIntegers), draw.of(kTypes)};
  }
  return extras;
}

void declare_extra(Element& element, const Extra& extra) {
  const std::string name = fmt::format("extra{}", element.properties.size());
  element.properties.push_back(
      extra.length_type.empty()
          ? fmt::format("{} {}", extra.type, name)
          : fmt::format("list {} {} {}", extra.length_type, extra.type, name));
}

void put_extra(Draw& draw, PlyRow& row, const Extra& extra) {
  std::size_t count = 1;
  if (!extra.length_type.empty()) {
    count = draw.below(4);
    row.push_back({extra.length_type, static_cast<double>(count)});
  }
  for (; count > 0; --count) put_number(draw, row, extra.type);
}

/// Returns the vertices: x, y and z in any order, with other properties between them.
Element drawn_vertices(Draw& draw, std::vector<glm::vec3>& vertices) {
  struct Property {
    int axis = 3;  // of an extra
    Extra extra;
  };
  std::vector<Property> properties;
  for (int axis = 0; axis < 3; ++axis) {
    properties.push_back({axis, {"", draw.once_in(2) ? "float" : draw.of(kTypes)}});
  }
  for (const Extra& extra : drawn_extras(draw)) properties.push_back({3, extra});
  for (std::size_t i = properties.size(); i > 1; --i) {
    std::swap(properties[i - 1], properties[draw.below(i)]);
  }
  Element element{"vertex", {}, {}};
  for (const Property& property : properties) {
    if (property.axis < 3) {
      element.properties.push_back(fmt::format("{} {}", property.extra.type, "xyz"[property.axis]));
    } else {
      declare_extra(element, property.extra);
    }
  }
  for (glm::vec3& vertex : vertices) {
    PlyRow& row = element.rows.emplace_back();
    for (const Property& property : properties) {
      if (property.axis == 3) {
        put_extra(draw, row, property.extra);
        continue;
      }
      const auto [number, expected] = drawn_number(draw, property.extra.type);
      row.push_back(number);
      vertex[property.axis] = expected;
    }
  }
  return element;
}

/// Returns an element whose rows are lists of vertices, with other properties around each.
Element listed(Draw& draw, std::string name, const std::vector<std::vector<double>>& lists,
               std::string_view type) {
  Element element{std::move(name), {}, {}};
  const std::string_view length_type = draw.of(kIntegers);
  const std::vector<Extra> before = drawn_extras(draw);
  const std::vector<Extra> after = drawn_extras(draw);
  for (const Extra& extra : before) declare_extra(element, extra);
  element.properties.push_back(fmt::format("list {} {} {}", length_type, type,
                                           draw.once_in(2) ? "vertex_index" : "vertex_indices"));
  for (const Extra& extra : after) declare_extra(element, extra);
  for (const std::vector<double>& list : lists) {
    PlyRow& row = element.rows.emplace_back();
    for (const Extra& extra : before) put_extra(draw, row, extra);
    row.push_back({length_type, static_cast<double>(list.size())});
    for (const double number : list) row.push_back({type, number});
    for (const Extra& extra : after) put_extra(draw, row, extra);
  }
  return element;
}

/// A mesh with its triangles, element by element.
struct DrawnPly {
  std::vector<Element> elements;
  std::vector<fuzz::Corners> triangles;
};

void add_faces(Draw& draw, const std::vector<glm::vec3>& vertices, DrawnPly& ply) {
  std::vector<std::vector<double>> lists;
  for (const auto& face : fuzz::drawn_faces(draw, vertices.size())) {
    lists.emplace_back(face.begin(), face.end());
    fuzz::expect_face(ply.triangles, vertices, face);
  }
  ply.elements.push_back(listed(draw, "face", lists, draw.of(kTypes)));
}

/// Adds lists of strips, separated by -1.
void add_strips(Draw& draw, const std::vector<glm::vec3>& vertices, DrawnPly& ply) {
  std::vector<std::vector<double>> lists(draw.below(3));
  for (auto& list : lists) {
    for (std::size_t strips = 1 + draw.below(3); strips > 0; --strips) {
      std::vector<std::uint32_t> strip(draw.below(7));
      for (std::uint32_t& corner : strip) {
        corner = static_cast<std::uint32_t>(draw.below(vertices.size()));
      }
      for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
        const std::size_t odd = i % 2;
        fuzz::expect_face(ply.triangles, vertices,
                          {strip[i + odd], strip[i + 1 - odd], strip[i + 2]});
      }
      list.insert(list.end(), strip.begin(), strip.end());
      if (strips > 1 || draw.once_in(3)) list.push_back(-1.0);
    }
  }
  ply.elements.push_back(listed(draw, "tristrips", lists, draw.of(kSigned)));
}

void add_other(Draw& draw, std::string name, DrawnPly& ply) {
  Element element{std::move(name), {}, {}};
  const std::vector<Extra> extras = drawn_extras(draw);
  for (const Extra& extra : extras) declare_extra(element, extra);
  element.rows.resize(extras.empty() ? 0 : draw.below(3));
  for (PlyRow& row : element.rows) {
    for (const Extra& extra : extras) put_extra(draw, row, extra);
  }
  ply.elements.push_back(std::move(element));
}

DrawnPly drawn_ply(Draw& draw) {
  std::vector<glm::vec3> vertices(1 + draw.below(9));
  DrawnPly ply;
  Element vertex = drawn_vertices(draw, vertices);
  if (draw.once_in(4)) add_other(draw, "camera", ply);
  const bool strips_first = draw.once_in(2);
  if (strips_first && draw.once_in(2)) add_strips(draw, vertices, ply);
  add_faces(draw, vertices, ply);
  if (!strips_first && draw.once_in(2)) add_strips(draw, vertices, ply);
  if (draw.once_in(4)) add_other(draw, "edge", ply);
  const std::size_t place = draw.once_in(2) ? 0 : draw.below(ply.elements.size() + 1);
  ply.elements.insert(ply.elements.begin() + static_cast<std::ptrdiff_t>(place), std::move(vertex));
  return ply;
}

/// Writes a line of the header, in any layout, followed by meaningless lines.
void write_line(Draw& draw, std::string& header, std::string_view line) {
  constexpr std::array<std::string_view, 6> kBetween = {
      "comment", "comment element face 3", "obj_info  property float x", "",
      " \t",     " comment end_header"};
  for (const char c : line) {
    if (c == ' ') {
      header += fuzz::drawn_blank(draw);
    } else {
      header += c;
    }
  }
  header += draw.once_in(16) ? " \n" : "\n";
  while (draw.once_in(10)) {
    header += draw.of(kBetween);
    header += '\n';
  }
}

std::string drawn_header(Draw& draw, const DrawnPly& ply, std::string_view encoding) {
  std::vector<std::string> lines;
  for (const Element& element : ply.elements) {
    lines.push_back(fmt::format("element {} {}", element.name, element.rows.size()));
    for (const std::string& property : element.properties) lines.push_back("property " + property);
  }
  const std::size_t format = draw.once_in(4) ? draw.below(lines.size() + 1) : 0;
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(format),
               fmt::format("format {} 1.0", encoding));
  std::string header;
  write_line(draw, header, "ply");
  for (const std::string& line : lines) write_line(draw, header, line);
  return header + (draw.once_in(8) ? "end_header \n" : "end_header\n");
}

/// Writes the rows of a text, in any layout.
std::string drawn_rows(Draw& draw, const Element& element) {
  std::string text;
  for (const PlyRow& row : element.rows) {
    while (draw.once_in(12)) text += " \n";
    if (draw.once_in(12)) text += '\t';
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i > 0) text += fuzz::drawn_blank(draw);
      tests::put_ply_number(text, row[i], "ascii");
    }
    text += draw.once_in(12) ? " \n" : "\n";
  }
  return text;
}

std::pair<std::string, std::vector<fuzz::Corners>> drawn_file(Draw& draw) {
  const std::string_view encoding = draw.of(tests::kPlyEncodings);
  DrawnPly ply = drawn_ply(draw);
  std::string text = drawn_header(draw, ply, encoding);
  const std::string_view line_end = draw.of(fuzz::kLineEnds);
  if (encoding == "ascii") {
    for (const Element& element : ply.elements) text += drawn_rows(draw, element);
    if (draw.once_in(4)) text.pop_back();  // no last line end
    return {fuzz::laid_out(draw, text, line_end), std::move(ply.triangles)};
  }
  std::string bytes = fuzz::laid_out(draw, text, line_end);
  for (const Element& element : ply.elements) bytes += tests::ply_rows(element.rows, encoding);
  return {bytes, std::move(ply.triangles)};
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes = fuzz::text_of(data, size);
  const auto read = [](std::string_view file) {
    return scenes::mesh::import_mesh(file, "ply", "input.ply");
  };
  if (const auto imported = fuzz::accepted([&] { return read(bytes); })) {
    fuzz::check_imported(*imported);
  }
  Draw draw(bytes);
  const auto [file, triangles] = drawn_file(draw);
  fuzz::check_scene(triangles, file, [&] { return read(file); });
  return 0;
}

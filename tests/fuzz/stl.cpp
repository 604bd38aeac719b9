// STL files: the input itself, and a valid file whose facets and layout are drawn from it.

#include <array>
#include <cctype>
#include <cstring>
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

namespace {

using namespace beambench;
using fuzz::Draw;

using StlFile = std::pair<std::string, std::vector<fuzz::Corners>>;

template <typename Number>
void put_little_endian(std::string& bytes, Number number) {
  std::array<char, sizeof(Number)> one{};
  std::memcpy(one.data(), &number, sizeof(Number));
  bytes.append(one.data(), one.size());
}

void expect_facet(std::vector<fuzz::Corners>& triangles, const std::vector<glm::vec3>& corners) {
  fuzz::expect_face(triangles, corners, {0, 1, 2});
}

StlFile drawn_binary(Draw& draw) {
  constexpr std::array<std::string_view, 4> kBegins = {"", "solid", "solid a\nfacet normal 0 0 0\n",
                                                       "COLOR=abcd"};
  StlFile file;
  auto& [bytes, triangles] = file;
  bytes = draw.of(kBegins);
  while (bytes.size() < 80) bytes += static_cast<char>(draw.once_in(2) ? ' ' : draw.below(256));
  const std::size_t count = draw.below(8);
  put_little_endian(bytes, static_cast<std::uint32_t>(count));
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) put_little_endian(bytes, draw.bits());
    std::vector<glm::vec3> corners(3);
    for (glm::vec3& corner : corners) {
      for (glm::length_t axis = 0; axis < 3; ++axis) {
        corner[axis] = fuzz::drawn_float(draw);
        put_little_endian(bytes, corner[axis]);
      }
    }
    put_little_endian(bytes, static_cast<std::uint16_t>(draw.bits()));
    expect_facet(triangles, corners);
  }
  return file;
}

/// Writes keywords, in any case, with blanks or a line end after each.
void write_words(Draw& draw, std::string& text, std::string_view words) {
  for (const char c : words) {
    const bool upper = draw.once_in(16);
    if (c == ' ') {
      text += draw.once_in(12) ? "\n" : fuzz::drawn_blank(draw);
    } else {
      text += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    }
  }
}

void write_name(Draw& draw, std::string& text) {
  constexpr std::array<std::string_view, 5> kNames = {"", " a", " a name, of words",
                                                      " facet normal", " 1 2 3"};
  text += draw.of(kNames);
  text += '\n';
}

void write_facet(Draw& draw, std::string& text, std::vector<fuzz::Corners>& triangles) {
  constexpr std::array<std::string_view, 4> kNormals = {"0 0 1 ", "nan nan nan ", "1.#QNAN 0 0 ",
                                                        "-1e-3 +2 3 "};
  write_words(draw, text, "facet normal ");
  text += draw.of(kNormals);
  write_words(draw, text, "outer loop ");
  std::vector<glm::vec3> corners(3);
  for (glm::vec3& corner : corners) {
    write_words(draw, text, "vertex ");
    for (glm::length_t axis = 0; axis < 3; ++axis) {
      const fuzz::DrawnNumber number = fuzz::drawn_decimal(draw);
      text += number.text;
      corner[axis] = number.expected;
      write_words(draw, text, " ");
    }
  }
  write_words(draw, text, "endloop endfacet ");
  text += '\n';
  expect_facet(triangles, corners);
}

StlFile drawn_text(Draw& draw) {
  std::string text;
  std::vector<fuzz::Corners> triangles;
  for (std::size_t solids = 1 + draw.below(3); solids > 0; --solids) {
    while (draw.once_in(8)) text += " \n";
    write_words(draw, text, "solid");
    write_name(draw, text);
    for (std::size_t facets = draw.below(5); facets > 0; --facets) {
      write_facet(draw, text, triangles);
    }
    write_words(draw, text, "endsolid");
    write_name(draw, text);
  }
  if (draw.once_in(4)) text.pop_back();  // no last line end
  return {fuzz::laid_out(draw, text, draw.of(fuzz::kLineEnds)), triangles};
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes = fuzz::text_of(data, size);
  const auto read = [](std::string_view file) {
    return scenes::mesh::import_mesh(file, "stl", "input.stl");
  };
  if (const auto imported = fuzz::accepted([&] { return read(bytes); })) {
    fuzz::check_imported(*imported);
  }
  Draw draw(bytes);
  const auto [file, triangles] = draw.once_in(2) ? drawn_binary(draw) : drawn_text(draw);
  fuzz::check_scene(triangles, file, [&] { return read(file); });
  return 0;
}

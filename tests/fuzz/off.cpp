// OFF files: the input itself, and a valid file whose mesh and layout are drawn from it.

#include <array>
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

/// Ends a line; comments and empty lines may follow.
void end_line(Draw& draw, std::string& text) {
  constexpr std::array<std::string_view, 5> kEnds = {"\n", " \n", " # a comment\n", "# 3 0 1 2\n",
                                                     "\t#\n"};
  constexpr std::array<std::string_view, 3> kBetween = {"\n", "#\n", " \t# 1 2 3\n"};
  text += draw.once_in(4) ? draw.of(kEnds) : "\n";
  while (draw.once_in(12)) text += draw.of(kBetween);
}

/// Writes the keyword and the counts. Returns how many numbers follow the coordinates.
std::size_t write_header(Draw& draw, std::string& text, std::size_t vertices, std::size_t faces) {
  struct Dialect {
    std::string_view keyword;
    std::size_t numbers;
  };
  constexpr std::array<Dialect, 10> kDialects = {{{"OFF", 0},
                                                  {"", 0},
                                                  {"COFF", 4},
                                                  {"COFF", 3},
                                                  {"NOFF", 3},
                                                  {"STOFF", 2},
                                                  {"CNOFF", 7},
                                                  {"STCNOFF", 9},
                                                  {"NCSTOFF", 8},
                                                  {"STNOFF", 5}}};
  const Dialect dialect = draw.once_in(2) ? kDialects[0] : draw.of(kDialects);
  while (draw.once_in(8)) text += "# before\n";
  text += dialect.keyword;
  const auto separate = [&] {
    if (draw.once_in(4)) {
      end_line(draw, text);
    } else {
      text += fuzz::drawn_blank(draw);
    }
  };
  if (!dialect.keyword.empty() && !draw.once_in(8)) separate();
  text += fmt::format("{}", vertices);
  separate();
  text += fmt::format("{}", faces);
  separate();
  text += draw.once_in(2) ? "0" : "-7";
  end_line(draw, text);
  return dialect.numbers;
}

void write_numbers(Draw& draw, std::string& text, std::size_t count) {
  constexpr std::array<std::string_view, 6> kNumbers = {"0", "255", "0.5", "1e-3", "-1", "+.25"};
  for (; count > 0; --count) {
    text += fuzz::drawn_blank(draw);
    text += draw.of(kNumbers);
  }
}

std::pair<std::string, std::vector<fuzz::Corners>> drawn_off(Draw& draw) {
  std::vector<glm::vec3> vertices(1 + draw.below(9));
  const auto faces = fuzz::drawn_faces(draw, vertices.size());
  std::string text;
  const std::size_t numbers = write_header(draw, text, vertices.size(), faces.size());
  for (glm::vec3& vertex : vertices) {
    for (glm::length_t axis = 0; axis < 3; ++axis) {
      const fuzz::DrawnNumber number = fuzz::drawn_decimal(draw);
      if (axis > 0) text += fuzz::drawn_blank(draw);
      text += number.text;
      vertex[axis] = number.expected;
    }
    write_numbers(draw, text, numbers);
    end_line(draw, text);
  }
  std::vector<fuzz::Corners> triangles;
  for (const auto& face : faces) {
    text += fmt::format("{}", face.size());
    for (const std::uint32_t corner : face) {
      text += fuzz::drawn_blank(draw);
      text += fmt::format("{}", corner);
    }
    if (draw.once_in(3)) write_numbers(draw, text, draw.below(5));
    end_line(draw, text);
    fuzz::expect_face(triangles, vertices, face);
  }
  if (draw.once_in(4)) text.pop_back();  // no last line end
  return {fuzz::laid_out(draw, text, draw.of(fuzz::kLineEnds)), triangles};
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes = fuzz::text_of(data, size);
  const auto read = [](std::string_view text) {
    return scenes::mesh::import_mesh(text, "off", "input.off");
  };
  if (const auto imported = fuzz::accepted([&] { return read(bytes); })) {
    fuzz::check_imported(*imported);
  }
  Draw draw(bytes);
  const auto [file, triangles] = drawn_off(draw);
  fuzz::check_scene(triangles, file, [&] { return read(file); });
  return 0;
}

// OFF files.
//
// The rules, by the manual of Geomview ("OFF Files"):
//
// - The keyword `[ST][C][N][4][n]OFF`, which may be missing, and the numbers of vertices, faces and
//   edges (the last is not checked), on one or more lines.
// - Vertices: x y z, then three numbers of a normal (N), a color (C) and two texture coordinates
//   (ST), depending on the keyword. A color has four numbers. In files of other programs, a color
// has three numbers, and the letters and numbers are in a different order.
// - Faces: the number of corners, the corners, counted from 0, and a color of 0 to 4 numbers.
// - `#` begins a comment.
//
// Colors, normals and texture coordinates are skipped. Each vertex and each face must be on a
// separate line, as programs write them; Geomview reads the numbers of vertices across line ends,
// so a missing number would shift all later ones. Four-dimensional (4), n-dimensional (n) and
// binary files are refused.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "scenes/base/decimal.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/formats/mesh/importers.hpp"
#include "scenes/formats/mesh/indexed_faces.hpp"
#include "scenes/formats/mesh/text_lines.hpp"

namespace beambench::scenes::mesh {
namespace {

struct OffHeader {
  bool has_normals = false;
  bool has_colors = false;
  bool has_textures = false;
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
};

bool is_decimal_digit(char c) { return c >= '0' && c <= '9'; }

/// Records the letters before `OFF`.
void read_letters(std::string_view letters, OffHeader& header, const TextLines& lines) {
  while (!letters.empty()) {
    std::size_t length = 1;
    if (letters.starts_with("ST")) {
      header.has_textures = true;
      length = 2;
    } else if (letters.starts_with('C')) {
      header.has_colors = true;
    } else if (letters.starts_with('N')) {
      header.has_normals = true;
    } else if (letters.starts_with('4') || letters.starts_with('n')) {
      throw InputError(
          fmt::format("'{}OFF' files have vertices of other than three coordinates, which are not "
                      "read; export it as OFF",
                      letters));
    } else {
      lines.refuse("the file does not begin with 'OFF'");
    }
    letters.remove_prefix(length);
  }
}

/// Takes the keyword. Returns the first count if it is in the same word: instead of the keyword or,
/// as in some faulty ModelNet files, directly after it ("OFF490"). Otherwise returns nothing.
std::string_view take_off_keyword(OffHeader& header, TextLines& lines) {
  const std::string_view word = lines.word();
  constexpr std::string_view kKeyword = "OFF";
  const std::size_t at = word.find(kKeyword);
  if (at == std::string_view::npos) {
    if (!integer_of(word)) lines.refuse("the file does not begin with 'OFF'");
    return word;
  }
  read_letters(word.substr(0, at), header, lines);
  const std::string_view count = word.substr(at + kKeyword.size());
  if (!std::all_of(count.begin(), count.end(), is_decimal_digit)) {
    lines.refuse(fmt::format("'{}' is not a keyword of OFF files", excerpt(word)));
  }
  return count;
}

OffHeader take_off_header(TextLines& lines) {
  OffHeader header;
  if (!lines.next_with_words()) throw InputError("it holds no text; export the mesh again");
  std::array<std::int64_t, 3> counts{};
  std::string_view word = take_off_keyword(header, lines);
  for (std::int64_t& count : counts) {
    if (word.empty()) word = lines.word_anywhere();
    if (word == "BINARY") {
      throw InputError("it is a binary OFF file, which is not read; export it as text");
    }
    const auto number = integer_of(word);
    if (!number) {
      lines.refuse(fmt::format("found '{}' where the numbers of vertices, faces and edges must be",
                               excerpt(word)));
    }
    count = *number;
    word = {};
  }
  if (const auto more = lines.word(); !more.empty()) {
    lines.refuse(
        fmt::format("'{}' follows the numbers of vertices, faces and edges", excerpt(more)));
  }
  if (counts[0] < 0 || counts[1] < 0) lines.refuse("a number of vertices or faces is negative");
  header.vertices = static_cast<std::uint64_t>(counts[0]);
  header.faces = static_cast<std::uint64_t>(counts[1]);
  return header;
}

/// Goes to the line of the next vertex or face.
void next_row(TextLines& lines, std::string_view what, std::uint64_t row, std::uint64_t count) {
  if (lines.next_with_words()) return;
  throw InputError(
      fmt::format("its header declares {} {}, but after {} the file ends: it is cut off, or its "
                  "header is invalid; get it again",
                  count, what, row));
}

/// Takes the rest of the line. Returns the number of numbers in it.
std::size_t skip_numbers(TextLines& lines, std::string_view what, std::uint64_t row) {
  std::size_t count = 0;
  for (auto word = lines.word(); !word.empty(); word = lines.word()) {
    if (!number_of<float>(word)) {
      lines.refuse(fmt::format("{} {}: '{}' is not a number", what, row, excerpt(word)));
    }
    ++count;
  }
  return count;
}

glm::vec3 take_off_vertex(TextLines& lines, const OffHeader& header, std::uint64_t row) {
  glm::vec3 place{};
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    const std::string_view word = lines.word();
    const auto number = number_of<float>(word);
    if (word.empty()) lines.refuse(fmt::format("vertex {} has fewer than three numbers", row));
    if (!number) lines.refuse(fmt::format("vertex {}: '{}' is not a number", row, excerpt(word)));
    place[axis] = *number;
  }
  const std::size_t others = (header.has_normals ? 3U : 0U) + (header.has_colors ? 4U : 0U) +
                             (header.has_textures ? 2U : 0U);
  const std::size_t found = skip_numbers(lines, "vertex", row);
  if (found != others && !(header.has_colors && found + 1 == others)) {
    lines.refuse(
        fmt::format("vertex {} has {} after its three coordinates, but the file's "
                    "keyword requires {}",
                    row, counted(found, "number", "numbers"), others));
  }
  return place;
}

void take_off_face(TextLines& lines, const OffHeader& header, std::uint64_t row,
                   IndexedFaces& faces) {
  const std::string_view size_word = lines.word();
  const auto size = integer_of(size_word);
  if (!size || *size < 0 || *size > std::numeric_limits<std::uint32_t>::max()) {
    lines.refuse(fmt::format("face {}: '{}' is not a number of corners", row, excerpt(size_word)));
  }
  for (std::int64_t i = 0; i < *size; ++i) {
    const std::string_view word = lines.word();
    if (word.empty()) {
      lines.refuse(fmt::format("face {} has {}, but declares {}", row,
                               counted(static_cast<std::size_t>(i), "corner", "corners"), *size));
    }
    const auto corner = integer_of(word);
    if (!corner || *corner < 0 || static_cast<std::uint64_t>(*corner) >= header.vertices) {
      lines.refuse(
          fmt::format("face {} refers to vertex '{}', but there are only {}, counted from 0", row,
                      excerpt(word), header.vertices));
    }
    faces.corners.push_back(static_cast<std::uint32_t>(*corner));
  }
  faces.sizes.push_back(static_cast<std::uint32_t>(*size));
  constexpr std::size_t kLongestColor = 4;
  if (const std::size_t color = skip_numbers(lines, "face", row); color > kLongestColor) {
    lines.refuse(fmt::format("face {} has {} after its corners, but a color has at most {}", row,
                             counted(color, "number", "numbers"), kLongestColor));
  }
}

ImportedMesh read_off(std::string_view bytes) {
  TextLines lines(bytes, '#');
  const OffHeader header = take_off_header(lines);
  if (header.faces == 0) {
    throw InputError(
        fmt::format("its header declares {} but no faces, and rays cannot hit a point cloud; "
                    "reconstruct its surface, or export the mesh with its faces",
                    counted(header.vertices, "vertex", "vertices")));
  }
  IndexedFaces faces;
  constexpr std::size_t kShortestVertex = 5;  // bytes: "0 0 0"
  faces.vertices.reserve(
      std::min<std::uint64_t>(header.vertices, lines.text_after().size() / kShortestVertex + 1));
  for (std::uint64_t row = 0; row < header.vertices; ++row) {
    next_row(lines, "vertices", row, header.vertices);
    faces.vertices.push_back(take_off_vertex(lines, header, row));
  }
  for (std::uint64_t row = 0; row < header.faces; ++row) {
    next_row(lines, "faces", row, header.faces);
    take_off_face(lines, header, row, faces);
  }
  if (lines.next_with_words()) {
    lines.refuse(
        fmt::format("'{}' follows the last face that the header declares", excerpt(lines.word())));
  }
  return mesh_of(std::move(faces));
}

/// The version of this importer; increment it whenever the format is read differently.
constexpr int kOffVersion = 1;

}  // namespace

Importer off_importer() {
  return {fmt::format("off-{}", kOffVersion),
          [](std::string_view bytes, const std::string&, const std::filesystem::path& path) {
            return with_file_name(path, bytes, read_off);
          }};
}

}  // namespace beambench::scenes::mesh

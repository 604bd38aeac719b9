#include "scenes/formats/mesh/obj_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "scenes/base/decimal.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/formats/mesh/obj_statements.hpp"

namespace beambench::scenes::mesh {
namespace {

[[noreturn]] void refuse_line(std::size_t line, std::string_view why) {
  throw InputError(
      fmt::format("it cannot be read as a mesh (line {}: {}); export it again", line, why));
}

void read_vertex(const ObjStatement& statement, ObjFile& file) {
  constexpr int kMax = 7;  // x y z, and r g b a
  glm::vec3 place(0.0F);
  std::string_view rest = statement.rest;
  int count = 0;
  for (auto word = take_word(rest); !word.empty(); word = take_word(rest), ++count) {
    const auto number = number_of<float>(word);
    if (number && count < 3) place[count] = *number;
    if (number && (count < 3 ? std::isfinite(*number) : !std::isinf(*number))) continue;
    refuse_line(statement.line, fmt::format("a vertex has the coordinate '{}', but must have "
                                            "numbers from -1e9 to 1e9",
                                            excerpt(word)));
  }
  if (count < 3) refuse_line(statement.line, "a vertex has fewer than three coordinates");
  if (count > kMax) {
    refuse_line(statement.line,
                fmt::format("a vertex has {} numbers, but must have 3 coordinates and at most a "
                            "color of 4 numbers",
                            count));
  }
  file.vertices.push_back(place);
}

/// Returns whether each slash, of at most two, is followed by nothing or an integer.
bool are_attributes(std::string_view text) {
  for (int count = 0; !text.empty(); ++count) {
    text.remove_prefix(1);
    const std::string_view index = text.substr(0, text.find('/'));
    if (count == 2 || (!index.empty() && !integer_of(index))) return false;
    text.remove_prefix(index.size());
  }
  return true;
}

/// Returns the vertex index, from 0, of `7`, `7/1`, `7//3` or `-1/-1/-1`. The vertex may be defined
/// later in the file.
std::uint32_t corner_of(std::string_view word, const ObjStatement& statement,
                        std::size_t vertices_before) {
  const std::string_view first = word.substr(0, word.find('/'));
  const std::optional<std::int64_t> index = integer_of(first);
  using Limits = std::numeric_limits<std::int32_t>;
  if (!index || *index == 0 || *index < Limits::min() || *index > Limits::max() ||
      !are_attributes(word.substr(first.size()))) {
    refuse_line(statement.line, fmt::format("a face has the corner '{}'; expected vertex numbers, "
                                            "which count from 1",
                                            excerpt(word)));
  }
  if (*index > 0) return static_cast<std::uint32_t>(*index) - 1;
  const std::int64_t place = static_cast<std::int64_t>(vertices_before) + *index;
  if (place < 0) {
    refuse_line(statement.line,
                fmt::format("a face refers to vertex {}, but only {} vertices precede it", *index,
                            vertices_before));
  }
  return static_cast<std::uint32_t>(place);
}

void read_face(const ObjStatement& statement, ObjFile& file) {
  const std::size_t first = file.corners.size();
  std::string_view rest = statement.rest;
  for (auto word = take_word(rest); !word.empty(); word = take_word(rest)) {
    file.corners.push_back(corner_of(word, statement, file.vertices.size()));
  }
  const std::size_t size = file.corners.size() - first;
  if (size == 0) {
    file.unknown.add(statement.line, statement.word);
  } else {
    file.face_sizes.push_back(static_cast<std::uint32_t>(size));
  }
}

void read_statement(const ObjStatement& statement, ObjFile& file) {
  switch (statement.kind) {
    case ObjKind::kVertex:
      read_vertex(statement, file);
      break;
    case ObjKind::kFace:
      read_face(statement, file);
      break;
    case ObjKind::kPointOrLine:
      ++file.points_and_lines;
      break;
    case ObjKind::kFreeForm:
      ++file.free_forms;
      break;
    case ObjKind::kLibrary:
      file.libraries.emplace_back(trimmed(statement.rest));
      break;
    case ObjKind::kMaterial:
      file.materials.emplace_back(file.face_sizes.size(), trimmed(statement.rest));
      break;
    case ObjKind::kUnknown:
      file.unknown.add(statement.line, statement.word);
      break;
    case ObjKind::kNothing:
    case ObjKind::kName:
    case ObjKind::kAttribute:
      break;
  }
}

/// Returns the line of the statement with the given corner, counted from 0 over the file.
std::size_t line_of_corner(std::string_view text, std::size_t corner) {
  ObjStatements statements(text);
  std::size_t before = 0;
  while (const auto statement = statements.next()) {
    if (statement->kind != ObjKind::kFace) continue;
    std::string_view rest = statement->rest;
    while (!take_word(rest).empty()) ++before;
    if (before > corner) return statement->line;
  }
  return 0;
}

}  // namespace

ObjFile read_obj(std::string_view text) {
  ObjFile file;
  ObjStatements statements(text);
  while (const auto statement = statements.next()) read_statement(*statement, file);
  const auto wrong =
      std::find_if(file.corners.begin(), file.corners.end(),
                   [&](std::uint32_t corner) { return corner >= file.vertices.size(); });
  if (wrong != file.corners.end()) {
    const auto number = static_cast<std::size_t>(wrong - file.corners.begin());
    refuse_line(line_of_corner(text, number),
                fmt::format("a face refers to vertex {}, but there are only {} vertices",
                            std::uint64_t{*wrong} + 1, file.vertices.size()));
  }
  return file;
}

}  // namespace beambench::scenes::mesh

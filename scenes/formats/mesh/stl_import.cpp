// STL files.
//
// The rules, by Marshall Burns, "Automated Fabrication" (1993), section 6.5, "The StL Format",
// after 3D Systems, "StereoLithography Interface Specification" (1989):
//
// - Binary: 80 bytes of any content, which may begin with `solid`; the number of facets, 32 bits,
//   little endian; 50 bytes per facet: the normal, three corners (12 floats) and 16 bits without an
//   agreed meaning. So the number of facets determines the length of the file and whether it is
//   binary.
// - Text: `solid NAME`; facets, each `facet normal X Y Z`, `outer loop`, three times
//   `vertex X Y Z`, `endloop`, `endfacet`; `endsolid NAME`. Words may be in any case, and blanks
//   and line ends between them are equivalent, except that names, which may be missing, end with
//   the line. Files in the wild may hold several solids.
//
// Normals and names are skipped.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "scenes/base/decimal.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/printable.hpp"
#include "scenes/formats/mesh/importers.hpp"
#include "scenes/formats/mesh/mesh_cleaning.hpp"
#include "scenes/formats/mesh/text_lines.hpp"

namespace beambench::scenes::mesh {
namespace {

using StlFacet = std::array<glm::vec3, 3>;

constexpr std::size_t kStlHeader = 84;
constexpr std::size_t kFacetBytes = 50;
constexpr std::size_t kNormalBytes = 12;

// Binary

template <typename Number>
Number little_endian(std::string_view bytes) {
  static_assert(std::endian::native == std::endian::little);
  Number number{};
  std::memcpy(&number, bytes.data(), sizeof(number));
  return number;
}

/// Returns the length of a binary file with the stated number of facets; nothing if the
/// number is missing.
std::optional<std::uint64_t> binary_stl_size(std::string_view bytes) {
  if (bytes.size() < kStlHeader) return std::nullopt;
  return kStlHeader + std::uint64_t{kFacetBytes} * little_endian<std::uint32_t>(bytes.substr(80));
}

ImportedMesh read_binary_stl(std::string_view bytes) {
  MeshCollector collector;
  collector.set_surface(clay());
  bytes.remove_prefix(kStlHeader);
  collector.reserve(bytes.size() / kFacetBytes / 2, bytes.size() / kFacetBytes);
  for (; !bytes.empty(); bytes.remove_prefix(kFacetBytes)) {
    collector.add(little_endian<StlFacet>(bytes.substr(kNormalBytes)));
  }
  return collected_mesh(std::move(collector), 0);
}

// Text

/// Returns whether a word is the keyword, ignoring case; `keyword` is in lower case.
bool is_keyword(std::string_view word, std::string_view keyword) {
  const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; };
  return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(), same);
}

std::string quoted_word(std::string_view word) {
  return word.empty() ? "the file ends" : fmt::format("found '{}'", excerpt(word));
}

void take_stl_keyword(TextLines& lines, std::string_view keyword) {
  const std::string_view word = lines.word_anywhere();
  if (is_keyword(word, keyword)) return;
  lines.refuse(fmt::format("{} where '{}' must be", quoted_word(word), keyword));
}

glm::vec3 take_corner(TextLines& lines) {
  glm::vec3 place{};
  for (glm::length_t axis = 0; axis < 3; ++axis) {
    const std::string_view word = lines.word_anywhere();
    const auto number = number_of<float>(word);
    if (!number) {
      lines.refuse(fmt::format("{} where a vertex must have a number", quoted_word(word)));
    }
    place[axis] = *number;
  }
  return place;
}

/// Takes a facet whose first word has already been taken.
StlFacet take_facet(TextLines& lines) {
  take_stl_keyword(lines, "normal");
  for (int axis = 0; axis < 3; ++axis) lines.word_anywhere();
  take_stl_keyword(lines, "outer");
  take_stl_keyword(lines, "loop");
  StlFacet facet{};
  for (glm::vec3& corner : facet) {
    take_stl_keyword(lines, "vertex");
    corner = take_corner(lines);
  }
  const std::string_view word = lines.word_anywhere();
  if (is_keyword(word, "vertex")) {
    lines.refuse("a loop has more than three vertices, but the facets of STL are triangles");
  }
  if (!is_keyword(word, "endloop")) {
    lines.refuse(fmt::format("{} where 'endloop' must be", quoted_word(word)));
  }
  take_stl_keyword(lines, "endfacet");
  return facet;
}

/// Takes a solid whose first word has already been taken.
void take_solid(TextLines& lines, MeshCollector& collector) {
  lines.skip_line();  // its name
  for (;;) {
    const std::string_view word = lines.word_anywhere();
    if (is_keyword(word, "facet")) {
      collector.add(take_facet(lines));
    } else if (is_keyword(word, "endsolid")) {
      lines.skip_line();
      return;
    } else {
      lines.refuse(fmt::format("{} where 'facet' or 'endsolid' must be", quoted_word(word)));
    }
  }
}

ImportedMesh read_text_stl(std::string_view text) {
  MeshCollector collector;
  collector.set_surface(clay());
  TextLines lines(text);
  for (auto word = lines.word_anywhere(); !word.empty(); word = lines.word_anywhere()) {
    if (!is_keyword(word, "solid")) {
      lines.refuse(fmt::format("{} where 'solid' must be", quoted_word(word)));
    }
    take_solid(lines, collector);
  }
  return collected_mesh(std::move(collector), 0);
}

/// Returns whether a file is meant to be text, if its length does not match a binary file.
bool is_text_stl(std::string_view bytes) {
  return is_keyword(TextLines(bytes).word_anywhere(), "solid") &&
         bytes.find('\0') == std::string_view::npos;
}

ImportedMesh read_stl(std::string_view bytes) {
  const auto size = binary_stl_size(bytes);
  if (size == bytes.size()) return read_binary_stl(bytes);
  if (is_text_stl(bytes)) return read_text_stl(bytes);
  if (!size) {
    throw InputError(
        "it is not an STL file: text must begin with 'solid', and a binary file has at least 84 "
        "bytes; export it again");
  }
  throw InputError(
      fmt::format("the number of its facets, {}, gives it {} bytes, but it has {}: it is cut off, "
                  "bytes follow its end, or it is text that does not begin with 'solid'; export it "
                  "again",
                  (*size - kStlHeader) / kFacetBytes, *size, bytes.size()));
}

/// The version of this importer; increment it whenever the format is read differently.
constexpr int kStlVersion = 1;

}  // namespace

Importer stl_importer() {
  return {fmt::format("stl-{}", kStlVersion),
          [](std::string_view bytes, const std::string&, const std::filesystem::path& path) {
            return with_file_name(path, bytes, read_stl);
          }};
}

}  // namespace beambench::scenes::mesh

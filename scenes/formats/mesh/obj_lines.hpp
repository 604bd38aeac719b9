#pragma once
// A look at the lines of an OBJ file, before it is read.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace beambench::scenes::mesh {

/// What tinyobjloader skips, or does not say.
struct ObjLines {
  std::size_t vertices = 0;
  std::size_t faces = 0;
  std::size_t points_and_lines = 0;
  std::size_t free_forms = 0;          ///< curves and surfaces
  std::vector<std::string> libraries;  ///< what follows each `mtllib`
};

/// Looks at the lines of a file. Throws InputError naming the line when a vertex has fewer than
/// three coordinates or one that is no number, or a face has a corner that is no index: such a word
/// would be read as 0. So it does for a line of numbers that `has_long_exponent`.
ObjLines obj_lines(std::string_view text);

/// Whether a number of the line has an exponent of ten digits or more, for which tinyobjloader's
/// integers are too small.
bool has_long_exponent(std::string_view line);

/// The text with lines that continue (after a backslash at their end) joined, and empty lines after
/// them, so that all others keep their numbers. Empty when no line continues.
std::string joined_lines(std::string_view text);

}  // namespace beambench::scenes::mesh

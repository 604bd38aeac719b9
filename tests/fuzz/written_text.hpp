#pragma once
// Equivalent layouts of a text: blanks, line ends and byte order marks.

#include <array>
#include <string>
#include <string_view>

#include "tests/fuzz/drawn_mesh.hpp"

namespace beambench::fuzz {

inline constexpr std::array<std::string_view, 3> kLineEnds = {"\n", "\r\n", "\r"};

/// Draws the blanks between two words of a line.
inline std::string_view drawn_blank(Draw& draw) {
  constexpr std::array<std::string_view, 4> kBlanks = {" ", "  ", "\t", " \t "};
  return draw.once_in(8) ? draw.of(kBlanks) : " ";
}

/// Returns the text with each LF replaced by the line end, with or without a byte order mark.
inline std::string laid_out(Draw& draw, std::string_view text, std::string_view line_end) {
  std::string result = draw.once_in(4) ? "\xEF\xBB\xBF" : "";
  for (const char c : text) {
    if (c == '\n') {
      result += line_end;
    } else {
      result += c;
    }
  }
  return result;
}

}  // namespace beambench::fuzz

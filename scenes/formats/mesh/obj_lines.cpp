#include "scenes/formats/mesh/obj_lines.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <system_error>

#include <fmt/format.h>

#include "scenes/core/error.hpp"
#include "scenes/core/printable.hpp"

namespace beambench::scenes::mesh {
namespace {

constexpr std::string_view kBlanks = " \t";

/// The next word of a line, which loses it; empty at the end.
std::string_view take_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

/// The next line, which the text loses, without its end: "\n", "\r\n" or "\r".
std::string_view take_line(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
  text.remove_prefix(line.size());
  if (text.starts_with("\r\n")) text.remove_prefix(1);
  if (!text.empty()) text.remove_prefix(1);
  return line;
}

[[noreturn]] void refuse_line(std::size_t line, std::string_view why) {
  throw InputError(
      fmt::format("it cannot be read as a mesh (line {}: {}); export it again", line, why));
}

/// Whether all of a text is a finite number, however small.
bool is_number(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (end != text.data() + text.size()) return false;
  if (error == std::errc::result_out_of_range) {
    return std::abs(std::strtod(std::string(text).c_str(), nullptr)) < 1.0;  // not too large
  }
  return error == std::errc() && std::isfinite(number);
}

void require_coordinate(std::string_view word, std::size_t line) {
  if (word.empty()) refuse_line(line, "a vertex has fewer than three coordinates");
  if (is_number(word.starts_with('+') ? word.substr(1) : word)) return;
  refuse_line(line, fmt::format("a vertex has the coordinate '{}', but must have numbers from -1e9 "
                                "to 1e9",
                                excerpt(word)));
}

/// `7`, `7/1`, `7//3`, `-1/-1/-1`: what comes before the slash.
void require_corner(std::string_view word, std::size_t line) {
  const std::string_view index = word.substr(0, word.find('/'));
  const std::string_view digits = index.starts_with('+') ? index.substr(1) : index;
  std::int32_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error == std::errc() && end == digits.data() + digits.size() && number != 0) return;
  refuse_line(line, fmt::format("a face has the corner '{}', but must have numbers of vertices, "
                                "which count from 1",
                                excerpt(word)));
}

bool is_digit(char letter) { return letter >= '0' && letter <= '9'; }

/// Whether numbers follow the word, rather than names.
bool takes_numbers(std::string_view word) { return word.starts_with('v') || word == "t"; }

bool is_free_form(std::string_view word) {
  return word == "curv" || word == "curv2" || word == "surf";
}

}  // namespace

ObjLines obj_lines(std::string_view text) {
  ObjLines found;
  for (std::size_t number = 1; !text.empty(); ++number) {
    std::string_view line = take_line(text);
    const std::string_view word = take_word(line);
    if (takes_numbers(word) && has_long_exponent(line)) {
      refuse_line(number, "a number has an exponent of ten digits or more");
    }
    if (word == "v") {
      ++found.vertices;
      for (int axis = 0; axis < 3; ++axis) require_coordinate(take_word(line), number);
    } else if (word == "f") {
      ++found.faces;
      for (auto corner = take_word(line); !corner.empty(); corner = take_word(line)) {
        require_corner(corner, number);
      }
    } else if (word == "l" || word == "p") {
      ++found.points_and_lines;
    } else if (word == "mtllib") {
      found.libraries.emplace_back(line);
    } else if (is_free_form(word)) {
      ++found.free_forms;
    }
  }
  return found;
}

bool has_long_exponent(std::string_view line) {
  constexpr std::size_t kLong = 10;
  for (std::size_t e = line.find_first_of("eE"); e != std::string_view::npos;
       e = line.find_first_of("eE", e + 1)) {
    if (e == 0 || !(is_digit(line[e - 1]) || line[e - 1] == '.')) continue;
    std::string_view exponent = line.substr(e + 1);
    if (exponent.starts_with('+') || exponent.starts_with('-')) exponent.remove_prefix(1);
    const auto end = std::find_if_not(exponent.begin(), exponent.end(), is_digit);
    if (static_cast<std::size_t>(end - exponent.begin()) >= kLong) return true;
  }
  return false;
}

std::string joined_lines(std::string_view text) {
  std::string joined;
  if (text.find("\\\n") == std::string_view::npos &&
      text.find("\\\r\n") == std::string_view::npos) {
    return joined;
  }
  joined.reserve(text.size() + 1);
  std::size_t owed = 0;  // ends of lines, which keep the numbers of those that follow
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.ends_with('\\')) {
      joined += line.substr(0, line.size() - 1);
      joined += ' ';
      ++owed;
    } else {
      joined += line;
      joined.append(1 + owed, '\n');
      owed = 0;
    }
  }
  return joined;
}

}  // namespace beambench::scenes::mesh

#pragma once
// PLY files for tests, generated in each encoding from one description.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace beambench::tests {

/// The three encodings, by their words in the header.
inline constexpr std::array<std::string_view, 3> kPlyEncodings = {"ascii", "binary_little_endian",
                                                                  "binary_big_endian"};

/// A number with its type, as spelled in the header. In a text file it is written as `text` if
/// given, otherwise as the shortest decimal that restores the number.
struct PlyNumber {
  std::string_view type;
  double value = 0.0;
  std::string text = {};
};

using PlyRow = std::vector<PlyNumber>;

/// Appends the bytes of a number of this type; assumes a little-endian machine.
template <typename Number>
void put_ply(std::string& bytes, double value, bool big_endian) {
  const auto number = static_cast<Number>(value);
  std::array<char, sizeof(Number)> one{};
  std::copy_n(reinterpret_cast<const char*>(&number), sizeof(Number), one.begin());
  if (big_endian) std::reverse(one.begin(), one.end());
  bytes.append(one.data(), one.size());
}

inline void put_ply_number(std::string& bytes, const PlyNumber& number, std::string_view encoding) {
  const bool big = encoding == "binary_big_endian";
  const std::string_view type = number.type;
  if (encoding == "ascii") {
    if (!number.text.empty()) {
      bytes += number.text;
    } else if (type == "float" || type == "float32") {
      bytes += fmt::format("{}", static_cast<float>(number.value));
    } else {
      bytes += fmt::format("{}", number.value);
    }
  } else if (type == "char" || type == "int8") {
    put_ply<std::int8_t>(bytes, number.value, big);
  } else if (type == "uchar" || type == "uint8") {
    put_ply<std::uint8_t>(bytes, number.value, big);
  } else if (type == "short" || type == "int16") {
    put_ply<std::int16_t>(bytes, number.value, big);
  } else if (type == "ushort" || type == "uint16") {
    put_ply<std::uint16_t>(bytes, number.value, big);
  } else if (type == "int" || type == "int32") {
    put_ply<std::int32_t>(bytes, number.value, big);
  } else if (type == "uint" || type == "uint32") {
    put_ply<std::uint32_t>(bytes, number.value, big);
  } else if (type == "float" || type == "float32") {
    put_ply<float>(bytes, number.value, big);
  } else {
    put_ply<double>(bytes, number.value, big);
  }
}

/// Returns the rows as they appear after the header.
inline std::string ply_rows(const std::vector<PlyRow>& rows, std::string_view encoding,
                            std::string_view line_end = "\n") {
  std::string bytes;
  for (const PlyRow& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (encoding == "ascii" && i > 0) bytes += ' ';
      put_ply_number(bytes, row[i], encoding);
    }
    if (encoding == "ascii") bytes += line_end;
  }
  return bytes;
}

/// Returns a file of these rows; `declarations` are the lines of elements and properties.
inline std::string ply_file(std::string_view encoding, std::string_view declarations,
                            const std::vector<PlyRow>& rows, std::string_view line_end = "\n") {
  const std::string header =
      fmt::format("ply\nformat {} 1.0\n{}end_header\n", encoding, declarations);
  std::string bytes;
  for (const char c : header) {
    if (c == '\n') {
      bytes += line_end;
    } else {
      bytes += c;
    }
  }
  return bytes + ply_rows(rows, encoding, line_end);
}

}  // namespace beambench::tests

#pragma once
// The rows of PLY files, as text and in binary: two classes with the same interface.
//
// `begin(element, row)` goes to a row and records it for messages; returns false at the end of the
// file. `number(type)` takes the next number of the row, `skip(type, count)` takes `count` of them,
// and `end()` ends the row. `finish()` throws unless the file is at its end. `at_most(properties)`
// bounds the number of rows with that many properties that the rest of the file can hold.
// `refuse(why)` throws InputError with the row and its position. The other functions throw it if a
// number is missing or not of its type.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "scenes/formats/mesh/ply_header.hpp"
#include "scenes/formats/mesh/text_lines.hpp"

namespace beambench::scenes::mesh {

/// One row per line; empty lines between rows are allowed.
class PlyTextRows {
 public:
  explicit PlyTextRows(const TextLines& after_header) : lines_(after_header) {}

  bool begin(const PlyElement& element, std::uint64_t row);
  double number(PlyType type);
  void skip(PlyType type, std::uint64_t count);
  void end();
  void finish();
  std::size_t at_most(std::size_t properties) const;
  [[noreturn]] void refuse(std::string_view why) const;

 private:
  std::string_view word();

  TextLines lines_;
  std::string_view element_;
  std::uint64_t row_ = 0;
};

/// Rows without separators.
class PlyBinaryRows {
 public:
  /// Reads a file with the contents `bytes`; `rest` is the part after the header.
  PlyBinaryRows(std::string_view bytes, std::string_view rest, PlyHeader::Encoding encoding);

  bool begin(const PlyElement& element, std::uint64_t row);
  double number(PlyType type);
  void skip(PlyType type, std::uint64_t count);
  void end() {}
  void finish();
  std::size_t at_most(std::size_t properties) const { return rest_.size() / properties; }
  [[noreturn]] void refuse(std::string_view why) const;

 private:
  template <typename Number>
  double take();
  std::size_t position() const { return size_ - rest_.size(); }

  std::size_t size_;
  std::string_view rest_;
  bool swapped_;  // its byte order differs from this machine's
  std::string_view element_;
  std::uint64_t row_ = 0;
};

}  // namespace beambench::scenes::mesh

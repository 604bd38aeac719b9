#pragma once
// The rows of PLY files, as text and in binary: two classes of one interface.
//
// `begin(element, row)` goes to a row, for messages, too; false where the file has ended.
// `number(type)` takes the next number of the row, `skip(type, count)` as many, and `end()` ends
// the row. `finish()` must find the file at its end. `at_most(properties)` bounds the rows with as
// many properties that what is left can hold. `refuse(why)` throws InputError that names the row
// and where it is. So do the others where a number is missing or none of its type.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "scenes/formats/mesh/ply_header.hpp"
#include "scenes/formats/mesh/text_lines.hpp"

namespace beambench::scenes::mesh {

/// A row on each line; empty lines between rows are allowed.
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

/// Rows without anything between them.
class PlyBinaryRows {
 public:
  /// The file holds `bytes`, of which `rest` is what follows the header.
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
  bool swapped_;  // its bytes are in the other order than those of this machine
  std::string_view element_;
  std::uint64_t row_ = 0;
};

}  // namespace beambench::scenes::mesh

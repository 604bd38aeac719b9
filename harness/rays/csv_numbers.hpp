#pragma once
// Reads CSV files of numbers: a line with the column names, then one line per record.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/base/files.hpp"

namespace beambench::rays {

/// Reads the records in order. Blanks around cells, a byte order mark, "\r\n" and a "# " before the
/// names (which NumPy writes) are skipped; names and numbers may be in quotation marks, and numbers
/// may be `inf` and `nan`. Blank lines are allowed only at the end.
class CsvNumbers {
 public:
  /// `first_line` has already been read from the input, and contains the names.
  CsvNumbers(std::filesystem::path path, InputStream input, std::string_view first_line);

  std::span<const std::string> columns() const { return columns_; }
  /// Fills a row, using `when_empty` for empty cells; a NaN means that the cell must not be empty.
  /// Returns false at the end. Throws InputError with file, line and column.
  bool next(std::span<double> row, std::span<const double> when_empty);
  /// Returns the place of the record with that index, such as `hits.csv:18`.
  std::string place_of(std::size_t index) const;

  const InputStream& input() const { return input_; }

 private:
  double number(std::string_view cell, std::size_t column, double when_empty) const;

  std::filesystem::path path_;
  InputStream input_;
  std::vector<std::string> columns_;
  std::size_t records_ = 0;
};

}  // namespace beambench::rays

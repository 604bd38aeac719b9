#pragma once
// Text output: aligned tables, wrapped text, sizes.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace beambench::cli {

/// A table of text, with two blanks between columns and a line under the header.
class TextTable {
 public:
  /// The first `left_columns` columns are flush left, the others flush right.
  explicit TextTable(std::vector<std::string> header, std::size_t left_columns = 1);

  /// Adds a row with as many cells as the header.
  void add(std::vector<std::string> row);
  /// Returns all lines, each with its line end.
  std::string text() const;

 private:
  std::size_t left_columns_;
  std::vector<std::vector<std::string>> rows_;  // the header first
};

/// Breaks a text at blanks into lines of at most `width` characters, each indented by `indent`
/// blanks and with its line end.
std::string wrap(std::string_view text, std::size_t indent, std::size_t width = 100);

/// Returns "312 bytes", "4.20 kB", "1.35 MB": powers of 1000.
std::string format_bytes(std::uint64_t bytes);

/// Returns "12.3%"; "-" if the whole is 0.
std::string format_share(std::uint64_t part, std::uint64_t whole);

}  // namespace beambench::cli

#include "harness/rays/csv_numbers.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "scenes/base/error.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::rays {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// Removes and returns the text before the next comma.
std::string_view take_cell(std::string_view& line) {
  const std::size_t comma = std::min(line.find(','), line.size());
  const std::string_view cell = line.substr(0, comma);
  line.remove_prefix(std::min(comma + 1, line.size()));
  return trimmed(cell);
}

/// Returns the text without the quotation marks that spreadsheets and R write around names and
/// numbers.
std::string_view unquoted(std::string_view cell) {
  const bool is_quoted = cell.size() >= 2 && cell.front() == '"' && cell.back() == '"';
  return is_quoted ? trimmed(cell.substr(1, cell.size() - 2)) : cell;
}

std::size_t count_cells(std::string_view line) {
  return 1 + static_cast<std::size_t>(std::ranges::count(line, ','));
}

std::vector<std::string> names_of(std::string_view line) {
  line = trimmed(line);
  if (line.starts_with('#')) line.remove_prefix(1);
  std::vector<std::string> names(count_cells(line));
  for (std::string& name : names) name = unquoted(take_cell(line));
  return names;
}

/// Parses a number; returns nothing if the text is not a number.
std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (stop != text.data() + text.size()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    // A number too small for double is 0, as its float would be; a number too large for double is
    // an error.
    if (text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos) {
      return 0.0;
    }
    return std::nullopt;
  }
  if (error != std::errc()) return std::nullopt;
  return value;
}

}  // namespace

CsvNumbers::CsvNumbers(std::filesystem::path path, InputStream input, std::string_view first_line)
    : path_(std::move(path)), input_(std::move(input)), columns_(names_of(first_line)) {}

std::string CsvNumbers::place_of(std::size_t index) const {
  return fmt::format("{}:{}", path_.string(), index + 2);
}

double CsvNumbers::number(std::string_view cell, std::size_t column, double when_empty) const {
  if (cell.empty() && !std::isnan(when_empty)) return when_empty;
  if (const auto value = parse_number(cell)) return *value;
  throw InputError(fmt::format("{}: column '{}' contains '{}', which is not a number",
                               place_of(records_), excerpt(columns_[column]), excerpt(cell)));
}

bool CsvNumbers::next(std::span<double> row, std::span<const double> when_empty) {
  const auto line = input_.line();
  if (!line) return false;
  std::string_view rest = *line;
  if (trimmed(rest).empty() && columns_.size() > 1) {
    while (const auto more = input_.line()) {
      if (trimmed(*more).empty()) continue;
      throw InputError(fmt::format(
          "{}: the line is blank, but records follow; remove or complete it", place_of(records_)));
    }
    return false;
  }
  if (const std::size_t cells = count_cells(rest); cells != columns_.size()) {
    throw InputError(fmt::format("{}: the line has {} cells, but there are {} columns",
                                 place_of(records_), cells, columns_.size()));
  }
  for (std::size_t i = 0; i < row.size(); ++i) {
    row[i] = number(unquoted(take_cell(rest)), i, when_empty[i]);
  }
  ++records_;
  return true;
}

}  // namespace beambench::rays

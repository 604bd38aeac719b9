#include "harness/bench/record/csv.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace beambench::bench {
namespace {

using Columns = std::vector<std::string>;

/// Adds the columns of `row` that `columns` lacks, each behind its predecessor.
void merge_columns(Columns& columns, const Row& row) {
  auto place = columns.begin();
  for (const auto& [name, value] : row.items()) {
    const auto found = std::find(columns.begin(), columns.end(), name);
    place = (found == columns.end() ? columns.insert(place, name) : found) + 1;
  }
}

std::string value_text(const Row& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{}", value.get<double>());
  return value.dump();
}

template <class Fields>
void append_line(std::string& text, const Fields& fields) {
  bool first = true;
  for (const std::string& field : fields) {
    if (!first) text += ',';
    text += csv_field(field);
    first = false;
  }
  text += '\n';
}

}  // namespace

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char letter : text) {
    if (letter == '"') field += '"';
    field += letter;
  }
  return field + '"';
}

std::string csv_table(std::span<const Row> rows) {
  Columns columns;
  for (const Row& row : rows) merge_columns(columns, row);
  std::string text;
  append_line(text, columns);
  for (const Row& row : rows) {
    std::vector<std::string> fields;
    fields.reserve(columns.size());
    for (const std::string& column : columns) {
      const auto found = row.find(column);
      fields.push_back(found == row.end() ? std::string() : value_text(*found));
    }
    append_line(text, fields);
  }
  return text;
}

}  // namespace beambench::bench

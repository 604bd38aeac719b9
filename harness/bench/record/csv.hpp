#pragma once
// Rows of a record as CSV (RFC 4180 quoting, one header row, no preamble).

#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace beambench::bench {

/// A row of a record: column names to numbers, texts, flags, or null for what was not measured. The
/// order is that of the columns.
using Row = nlohmann::ordered_json;

/// A text as a CSV field: in quotes, inner quotes doubled, when it holds a comma, quote or line
/// end.
std::string csv_field(std::string_view text);

/// Header and rows, lines ending with a line feed. The columns are those of the first row; columns
/// that only later rows have are inserted behind the one they follow there. What a row lacks, and
/// null, is an empty field; numbers are in their shortest exact form.
std::string csv_table(std::span<const Row> rows);

}  // namespace beambench::bench

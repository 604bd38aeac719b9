#pragma once
// results.csv: one row for each cell of a run.

#include <iosfwd>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "harness/measure/record/run_log.hpp"

namespace beambench::analysis {

/// A row: column names to numbers, texts, flags, or null for what was not measured, in the order of
/// the columns.
using Row = nlohmann::ordered_json;

/// The version of the columns of results.csv, and its first column. Incremented when a column
/// changes its name, meaning or unit or is removed, since a reader of the old columns would err,
/// but not for a new column. The meaning of each is in scripts/beambench_report/columns.json.
inline constexpr int kSchemaVersion = 2;

/// Returns what every row of a run has in common.
measure::RunFacts facts_of(const nlohmann::ordered_json& manifest);

/// Returns the same for the cells of each shard of a merged run, by its number, each with the
/// machine that measured it. Number 0 has the cells of a run that was not merged.
std::map<int, measure::RunFacts> facts_by_shard(const nlohmann::ordered_json& manifest);

/// Returns the row of a cell. A cell that does not keep its times has null there.
Row to_row(const measure::RunFacts& run, const measure::CellRecord& cell, bool outpaced = false);

/// Returns a text as a CSV field: in quotes, inner quotes doubled, if it contains a comma, quote or
/// line end. A text that begins with a character at which a spreadsheet takes it for a formula (=,
/// +, -, @, tab, carriage return), or with an apostrophe, gets an apostrophe before it, which
/// readers drop (scripts/beambench_report/base/csv_texts.py).
std::string csv_field(std::string_view text);

/// Returns header and rows, lines ending with a line feed. The columns are those of the first row;
/// columns that only later rows have are inserted after the one they follow there. Columns missing
/// from a row, and null, are empty fields; numbers are in their shortest exact form.
std::string csv_table(std::span<const Row> rows);

/// Writes the table of a run's cells. Each row of a merged run has the machine of its shard.
void write_results(std::ostream& out, const measure::Run& run);

}  // namespace beambench::analysis

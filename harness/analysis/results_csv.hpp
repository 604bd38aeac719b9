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

/// A row: column names mapped to numbers, strings, booleans, or null for unmeasured values, in
/// column order.
using Row = nlohmann::ordered_json;

/// The version of the columns of results.csv, and its first column. Incremented when a column
/// changes its name, meaning or unit, or is removed, because programs made for the old columns
/// would misread the file; not incremented for a new column. scripts/beambench_report/columns.json
/// defines each column.
inline constexpr int kSchemaVersion = 2;

/// Returns the facts shared by every row of a run.
measure::RunFacts facts_of(const nlohmann::ordered_json& manifest);

/// Returns the facts shared by the cells of each shard of a merged run, with the shard's machine,
/// keyed by the number of the shard. Number 0 stands for the cells of a run that was not merged.
std::map<int, measure::RunFacts> facts_by_shard(const nlohmann::ordered_json& manifest);

/// Returns the row of a cell. Times are null unless `cell.keeps_times()`.
Row to_row(const measure::RunFacts& run, const measure::CellRecord& cell, bool outpaced = false);

/// Returns a string as a CSV field. A string that contains a comma, a quote or a line end is put in
/// quotes, and its own quotes are doubled. A string that begins with an apostrophe, or with a
/// character that makes spreadsheets read a formula (=, +, -, @, tab, carriage return), is prefixed
/// with an apostrophe, which readers drop (scripts/beambench_report/base/csv_texts.py).
std::string csv_field(std::string_view text);

/// Returns the header and the rows, with lines ending in a line feed. The columns are those of the
/// first row; a column that only a later row has is inserted after its predecessor in that row.
/// Missing columns and null become empty fields; numbers are in their shortest exact form.
std::string csv_table(std::span<const Row> rows);

/// Writes the table of a run's cells. Each row of a merged run has the machine of its shard.
void write_results(std::ostream& out, const measure::Run& run);

}  // namespace beambench::analysis

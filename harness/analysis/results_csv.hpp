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

/// A row: column names mapped to numbers, texts, booleans, or null for unmeasured values, in column
/// order.
using Row = nlohmann::ordered_json;

/// The version of the columns of results.csv, and its first column. Incremented when a column
/// changes its name, meaning or unit, or is removed, because readers of the old columns would err;
/// not incremented for a new column. scripts/beambench_report/columns.json defines each column.
inline constexpr int kSchemaVersion = 2;

/// Returns the facts shared by every row of a run.
measure::RunFacts facts_of(const nlohmann::ordered_json& manifest);

/// Returns these facts for the cells of each shard of a merged run, keyed by its number, each with
/// the machine that measured it. Number 0 stands for the cells of a run that was not merged.
std::map<int, measure::RunFacts> facts_by_shard(const nlohmann::ordered_json& manifest);

/// Returns the row of a cell. Times are null for a cell that does not keep its times.
Row to_row(const measure::RunFacts& run, const measure::CellRecord& cell, bool outpaced = false);

/// Returns a text as a CSV field: in quotes, inner quotes doubled, if it contains a comma, quote or
/// line end. An apostrophe is put before a text that begins with an apostrophe or with a character
/// that makes spreadsheets read a formula (=, +, -, @, tab, carriage return); readers drop it
/// (scripts/beambench_report/base/csv_texts.py).
std::string csv_field(std::string_view text);

/// Returns header and rows, with lines ending in a line feed. The columns are those of the first
/// row; a column that only later rows have is inserted after its predecessor there. Missing columns
/// and null become empty fields; numbers are in their shortest exact form.
std::string csv_table(std::span<const Row> rows);

/// Writes the table of a run's cells. Each row of a merged run has the machine of its shard.
void write_results(std::ostream& out, const measure::Run& run);

}  // namespace beambench::analysis

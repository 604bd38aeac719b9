#pragma once
// The folder of a run: one file for each finished cell, and all that is derived from them.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/bench/record/cell_record.hpp"
#include "scenes/core/files.hpp"

namespace beambench::bench {

/// Keeps what is finished, whatever happens next (Ctrl-C, a kill, a full disk, a power loss):
/// `cells/<key>.json` is whole or absent, results.csv is written anew from the cells after each,
/// and a folder with a manifest.json holds a run. Memory holds what cells are called, not the
/// cells: a run may have any number. One process at a time may have a folder. Methods throw
/// InputError when the folder cannot be written, or a file of it no longer be read.
class RunFolder {
 public:
  /// Makes a folder for a new run; throws InputError when it already holds one.
  static RunFolder create(const std::filesystem::path& path);
  /// Opens the folder of a run that was begun; throws InputError when it holds none or a file of it
  /// cannot be read. What a kill left half-written is removed.
  static RunFolder open(const std::filesystem::path& path);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path results() const { return path_ / "results.csv"; }

  nlohmann::ordered_json read_json(const std::string& name) const;
  void write_json(const std::string& name, const nlohmann::ordered_json& document) const;
  void write_text(const std::string& name, const std::string& text) const;

  /// Whether a cell is finished, by its `CellId::key`.
  bool has_cell(const std::string& key) const { return keys_.contains(key); }
  /// Of the finished cells.
  const std::set<std::string>& keys() const { return keys_; }
  std::size_t cell_count() const { return cells_.size(); }
  /// Keeps a finished cell and brings results.csv up to date.
  void add_cell(const nlohmann::ordered_json& cell);
  /// Keeps a finished cell as one of many: `write_results` is to be called after the last.
  void take_cell(const nlohmann::ordered_json& cell);
  /// Makes results.csv from the cells: a kill may have come between a cell and its row.
  void write_results();
  /// Reads the finished cells, one by one, in the order of the plan. Throws InputError naming the
  /// cell's file where `visit` finds a value missing or of another type.
  void for_each_cell(const CellVisitor& visit) const;

 private:
  explicit RunFolder(std::filesystem::path path) : path_(std::move(path)), lock_(path_) {}
  /// Where a finished cell is.
  struct Place {
    std::string file;             ///< its name, in the folder of cells
    std::uint64_t row_bytes = 0;  ///< of its row in results.csv
  };

  void load_cells();
  /// Writes a cell's file; returns what `remember` does.
  bool keep(const nlohmann::ordered_json& cell);
  /// Returns whether it is a new one.
  bool remember(const nlohmann::ordered_json& cell, const std::string& file);
  bool insert_row(std::size_t index, const std::string& row);

  std::filesystem::path path_;
  FolderLock lock_;
  std::set<std::string> keys_;
  std::map<std::size_t, Place> cells_;  ///< by index in the plan
  std::vector<std::string> columns_;    ///< of results.csv
  std::uint64_t header_bytes_ = 0;
};

/// Throws InputError when a folder holds no run that could be resumed.
void require_run(const std::filesystem::path& folder);

/// What differs between the runs of two manifests and makes their cells incomparable, in a clause:
/// the program, the plug-ins or a scene that both have; empty where nothing does.
std::string program_difference(const nlohmann::ordered_json& first,
                               const nlohmann::ordered_json& second);

/// Throws InputError when the run in `folder` was made with another configuration, by another
/// program or machine, with other plug-ins or with a scene that has changed since: its cells and
/// new ones would not compare. The reason is named.
void require_same_run(const RunFolder& folder, const nlohmann::json& config,
                      const nlohmann::ordered_json& manifest);

/// A text as a CSV field: in quotes, inner quotes doubled, when it holds a comma, quote or line
/// end. One that begins with a character at which a spreadsheet takes it for a formula (=, +, -, @,
/// tab, carriage return), or with an apostrophe, gets an apostrophe before it, which readers drop
/// (scripts/beambench_report/base/csv_texts.py).
std::string csv_field(std::string_view text);

/// Header and rows, lines ending with a line feed. The columns are those of the first row; columns
/// that only later rows have are inserted after the one they follow there. What a row lacks, and
/// null, is an empty field; numbers are in their shortest exact form.
std::string csv_table(std::span<const Row> rows);

}  // namespace beambench::bench

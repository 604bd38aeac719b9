#include "harness/bench/record/run_folder.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <ostream>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/bench/record/shard.hpp"
#include "scenes/core/error.hpp"
#include "scenes/core/files.hpp"
#include "scenes/core/json_text.hpp"
#include "scenes/core/printable.hpp"
#include "scenes/core/shell_word.hpp"

namespace beambench::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kCells = "cells";
constexpr const char* kManifest = "manifest.json";
constexpr const char* kResults = "results.csv";

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) {
    throw InputError(fmt::format("cannot make the folder '{}': {}; choose another with -o",
                                 path.string(), error.message()));
  }
}

constexpr const char* kRemedy =
    "remove a cell's file to have the cell measured again, or begin a new run with -o";

Json parse_file(const fs::path& path) {
  try {
    return read_json_file<Json>(path);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}; {}", error.what(), kRemedy));
  }
}

void remove_left_behind(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (is_left_behind(entry.path())) fs::remove(entry.path(), ignored);
  }
}

/// A run that was killed before its manifest was whole has measured nothing and counts as none.
bool holds_run(const fs::path& path) {
  const fs::path cells = path / kCells;
  return fs::exists(path / kManifest) || fs::exists(path / kResults) ||
         (fs::exists(cells) && !fs::is_empty(cells));
}

/// A member of a manifest as text, whatever it is; empty where there is none.
std::string member(const Json& manifest, const char* pointer) {
  const Json::json_pointer place(pointer);
  return manifest.contains(place) ? json_text(manifest.at(place), -1) : "";
}

/// The hashes of a manifest's plug-ins or scenes, by file or name.
std::map<std::string, std::string> hashes(const Json& manifest, const char* list, const char* key) {
  std::map<std::string, std::string> found;
  for (const Json& each : manifest.value(list, Json::array())) {
    found[each.at(key).get<std::string>()] = each.at("hash").get<std::string>();
  }
  return found;
}

using Columns = std::vector<std::string>;

/// Adds the columns of `row` that `columns` lacks, each behind its predecessor.
void merge_columns(Columns& columns, const Row& row) {
  auto place = columns.begin();
  for (const auto& [name, value] : row.items()) {
    const auto found = std::find(columns.begin(), columns.end(), name);
    place = (found == columns.end() ? columns.insert(place, name) : found) + 1;
  }
}

/// A value as a CSV field.
std::string field_of(const Row& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return csv_field(value.get<std::string>());
  if (value.is_number_float()) return fmt::format("{}", value.get<double>());
  return json_text(value, -1);
}

std::string csv_line(const std::vector<std::string>& fields) {
  return fmt::format("{}\n", fmt::join(fields, ","));
}

std::string csv_header(const Columns& columns) {
  std::vector<std::string> fields;
  fields.reserve(columns.size());
  for (const std::string& column : columns) fields.push_back(csv_field(column));
  return csv_line(fields);
}

std::string csv_line(const Columns& columns, const Row& row) {
  std::vector<std::string> fields;
  fields.reserve(columns.size());
  for (const std::string& column : columns) {
    const auto found = row.find(column);
    fields.push_back(found == row.end() ? std::string() : field_of(*found));
  }
  return csv_line(fields);
}

/// Copies the next bytes of an input.
void copy(InputStream& from, std::uint64_t count, std::ostream& to) {
  std::array<char, 1U << 16U> block{};
  while (count > 0) {
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(count, block.size()));
    const std::size_t got = from.read({block.data(), wanted});
    if (got == 0) return;
    to.write(block.data(), static_cast<std::streamsize>(got));
    count -= got;
  }
}

}  // namespace

void require_run(const fs::path& folder) {
  if (fs::exists(folder / kManifest)) return;
  throw InputError(fmt::format("'{}' holds no run to resume: there is no {}; begin one with -o",
                               folder.string(), kManifest));
}

RunFolder RunFolder::create(const fs::path& path) {
  make_folder(path);
  RunFolder folder(path);
  if (holds_run(path)) {
    throw InputError(
        fmt::format("'{}' already holds a run; resume it with --resume '{}', or "
                    "choose another folder with -o",
                    path.string(), path.string()));
  }
  make_folder(path / kCells);
  remove_left_behind(path);
  return folder;
}

RunFolder RunFolder::open(const fs::path& path) {
  require_run(path);
  RunFolder folder(path);
  make_folder(path / kCells);
  remove_left_behind(path);
  remove_left_behind(path / kCells);
  folder.load_cells();
  return folder;
}

Json RunFolder::read_json(const std::string& name) const { return parse_file(path_ / name); }

void RunFolder::write_json(const std::string& name, const Json& document) const {
  write_text(name, json_text(document) + '\n');
}

void RunFolder::write_text(const std::string& name, const std::string& text) const {
  write_file(path_ / name, text);
}

bool RunFolder::keep(const Json& cell) {
  const std::string file = cell.at("key").get<std::string>() + ".json";
  write_file(path_ / kCells / file, json_text(cell) + '\n');
  return remember(cell, file);
}

void RunFolder::take_cell(const Json& cell) { keep(cell); }

void RunFolder::add_cell(const Json& cell) {
  const Row& row = cell.at("row");
  const std::size_t columns_before = columns_.size();
  merge_columns(columns_, row);
  const bool fits = keep(cell) && columns_.size() == columns_before &&
                    insert_row(cell.at("index").get<std::size_t>(), csv_line(columns_, row));
  if (!fits) write_results();
}

void RunFolder::for_each_cell(const CellVisitor& visit) const {
  for (const auto& [index, place] : cells_) {
    const fs::path file = path_ / kCells / place.file;
    read_as_written(file.string(), kRemedy, [&] { visit(parse_file(file)); });
  }
}

/// Puts the row of a cell that is in the plan, but not in results.csv yet, behind those before it:
/// nothing else of the file changes. False where the file is not what was written last.
bool RunFolder::insert_row(std::size_t index, const std::string& row) {
  std::uint64_t before = header_bytes_;
  std::uint64_t after = 0;
  for (const auto& [place, cell] : cells_) (place < index ? before : after) += cell.row_bytes;
  std::error_code unknown;
  if (fs::file_size(results(), unknown) != before + after || unknown) return false;
  InputStream old(results());
  write_file(results(), [&](std::ostream& out) {
    copy(old, before, out);
    out << row;
    copy(old, after, out);
  });
  cells_.at(index).row_bytes = row.size();
  return true;
}

void RunFolder::load_cells() {
  for (const auto& entry : fs::directory_iterator(path_ / kCells)) {
    if (entry.path().extension() != ".json") continue;
    const Json cell = parse_file(entry.path());
    for (const char* member : {"index", "key", "row", "repetitions", "name", "message"}) {
      if (cell.contains(member)) continue;
      throw InputError(fmt::format("'{}' is not a cell of a run: it has no '{}'; remove it",
                                   entry.path().string(), member));
    }
    read_as_written(entry.path().string(), kRemedy,
                    [&] { remember(cell, entry.path().filename().string()); });
  }
}

bool RunFolder::remember(const Json& cell, const std::string& file) {
  keys_.insert(cell.at("key").get<std::string>());
  return cells_.insert_or_assign(cell.at("index").get<std::size_t>(), Place{file, 0}).second;
}

void RunFolder::write_results() {
  columns_.clear();
  for_each_cell([&](const Json& cell) { merge_columns(columns_, cell.at("row")); });
  write_file(results(), [&](std::ostream& out) {
    const std::string header = csv_header(columns_);
    header_bytes_ = header.size();
    out << header;
    for_each_cell([&](const Json& cell) {
      const std::string row = csv_line(columns_, cell.at("row"));
      cells_.at(cell.at("index").get<std::size_t>()).row_bytes = row.size();
      out << row;
    });
  });
}

namespace {

void require_same(const RunFolder& folder, const nlohmann::json& config, const Json& now) {
  const auto refuse = [&](const std::string& reason) {
    throw InputError(fmt::format("cannot resume '{}': {}; begin a new run with -o",
                                 folder.path().string(), reason));
  };
  const nlohmann::json config_then = folder.read_json("config.json");
  const nlohmann::json changes = nlohmann::json::diff(config_then, config);
  if (!changes.empty()) {
    refuse(fmt::format("the configuration has changed at {}",
                       changes.front().at("path").get<std::string>()));
  }
  const Json then = folder.read_json(kManifest);
  const auto differs = [&](const char* pointer) {
    return member(then, pointer) != member(now, pointer);
  };
  if (differs("/program/commit")) {
    refuse(fmt::format("it was begun by beambench of commit {}, this one is of {}",
                       member(then, "/program/commit"), member(now, "/program/commit")));
  }
  if (differs("/program/executable_hash")) {
    refuse(
        "it was begun by another build of beambench, from changed sources or with other options");
  }
  if (is_merged(then)) refuse("it was merged from the shards of a sweep, and is complete");
  if (differs("/machine/id")) refuse("it was begun on another machine");
  const auto plugins = hashes(now, "plugins", "file");
  for (const auto& [file, hash] : hashes(then, "plugins", "file")) {
    const auto found = plugins.find(file);
    if (found == plugins.end()) {
      refuse(fmt::format("it was begun with --plugin {}", shell_quoted(path_of_name(file))));
    } else if (found->second != hash) {
      refuse(fmt::format("the plug-in {} has changed since", file));
    }
  }
  const auto earlier = hashes(then, "scenes", "name");
  for (const auto& [name, hash] : hashes(now, "scenes", "name")) {
    const auto found = earlier.find(name);
    if (found != earlier.end() && found->second != hash) {
      refuse(fmt::format("the scene {} has changed since", json_text(Json(name), -1)));
    }
  }
}

}  // namespace

std::string program_difference(const Json& first, const Json& second) {
  const auto differs = [&](const char* pointer) {
    return member(first, pointer) != member(second, pointer);
  };
  if (differs("/program/commit")) {
    return fmt::format("one is by beambench of commit {}, the other of {}",
                       member(first, "/program/commit"), member(second, "/program/commit"));
  }
  if (differs("/program/executable_hash")) {
    return "they are by two builds of beambench, from other sources or with other options";
  }
  if (hashes(first, "plugins", "file") != hashes(second, "plugins", "file")) {
    return "they were run with other plug-ins";
  }
  const auto scenes = hashes(first, "scenes", "name");
  for (const auto& [name, hash] : hashes(second, "scenes", "name")) {
    const auto found = scenes.find(name);
    if (found != scenes.end() && found->second != hash) {
      return fmt::format("the scene {} is not the same in both (scene hashes {} and {})",
                         json_text(Json(name), -1), found->second, hash);
    }
  }
  return "";
}

void require_same_run(const RunFolder& folder, const nlohmann::json& config, const Json& now) {
  read_as_written((folder.path() / kManifest).string(), "begin a new run with -o",
                  [&] { require_same(folder, config, now); });
}

std::string csv_field(std::string_view text) {
  constexpr std::string_view kFormulaOrApostrophe = "=+-@\t\r'";
  std::string guarded(text);
  if (!text.empty() && kFormulaOrApostrophe.find(text.front()) != std::string_view::npos) {
    guarded.insert(0, 1, '\'');
  }
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return guarded;
  std::string field = "\"";
  for (const char letter : guarded) {
    if (letter == '"') field += '"';
    field += letter;
  }
  return field + '"';
}

std::string csv_table(std::span<const Row> rows) {
  Columns columns;
  for (const Row& row : rows) merge_columns(columns, row);
  std::string text = csv_header(columns);
  for (const Row& row : rows) text += csv_line(columns, row);
  return text;
}

}  // namespace beambench::bench

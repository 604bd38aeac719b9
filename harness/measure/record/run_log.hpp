#pragma once
// The log of a run, run.jsonl: the record from which all other files of its folder are made.
//
// One JSON object a line, in the order of events, never rewritten:
//   header        schema_version, manifest, config, plan: index and name of each cell
//   resumed       manifest: the run goes on in another process
//   tuning        the parameter sets of tuned contenders in a view: camera, times, the cells kept
//   block         the contenders of a view are measured in a new process: its number, the load
//   cell          the timing of a cell begins: what it is, its rays, its counters and sizes;
//                 in logs without repetitions, `columns`: figures of results.csv made from them
//   repetition    a timed one of a cell, in a block, with its second trace
//   verification  of the hits of a cell's first repetition
//   warning       a sentence on what could not be controlled
//   throttling    how the kernel throttled the run so far, with the parts before it was resumed
//   finished      a cell needs no further repetition: verdict, reason, message, examples
//   end           every cell is finished
// A cell is named by its `index` in the plan of the whole sweep.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/measure/record/cell_events.hpp"
#include "scenes/base/cpu_quota.hpp"
#include "scenes/base/files.hpp"

namespace beambench::measure {

/// The version of the log. Incremented when a reader of the old one would fail. Version 1 had no
/// blocks: its repetitions are those of one process.
inline constexpr int kLogVersion = 2;

/// The name of the log in a run's folder.
inline constexpr const char* kLogName = "run.jsonl";
/// The name of a log that was packed by gzip for keeping; it is read where the other is missing.
inline constexpr const char* kPackedLogName = "run.jsonl.gz";

/// A cell of a plan.
struct PlannedName {
  std::size_t index;  ///< in the plan of the whole sweep
  std::string name;   ///< as `CellId::name`
};

/// A run as recorded in its log.
struct Run {
  /// The manifest, updated by later events: warnings, throttling, the end.
  nlohmann::ordered_json manifest;
  nlohmann::json config;
  std::vector<PlannedName> plan;         ///< without the cells that tuning left out
  std::vector<PlannedName> passed_over;  ///< by tuning: other parameter sets were faster
  /// The cells that were begun, in the order of the plan. A cell that is not finished has the
  /// verdict of its verification, and is missing before it.
  std::vector<CellRecord> cells;
  std::uint64_t log_bytes = 0;  ///< of the whole lines of the log

  bool is_ended() const { return manifest.at("finished_utc").is_string(); }
};

/// Reads the log in a folder, up to its last whole line, after which the run was cut off. Throws
/// InputError if the log is missing or cannot be read, with the line that is not as it was written.
Run read_run(const std::filesystem::path& folder);

/// Throws InputError when a folder holds no run that could be resumed.
void require_run(const std::filesystem::path& folder);

/// Writes the log of a run. Each event has been passed to the system when its function returns;
/// only the header waits for the disk. One process at a time may have a folder. All functions throw
/// InputError when the log cannot be written; it then ends with its last event.
class RunLog {
 public:
  /// Takes a folder, which is created, for a new run; throws InputError when it already holds one.
  static RunLog create(const std::filesystem::path& folder);
  /// Takes the folder of a run to resume or to read; throws InputError when it holds none.
  static RunLog open(const std::filesystem::path& folder);

  const std::filesystem::path& folder() const { return folder_; }

  /// Writes the header of a new run.
  void begin(const nlohmann::ordered_json& manifest, const nlohmann::json& config,
             std::span<const PlannedName> plan);
  /// Continues an opened log behind its whole lines, which have that many bytes.
  void resume(const nlohmann::ordered_json& manifest, std::uint64_t log_bytes);

  /// Adds an event: of a cell (`CellEvents`), or of another log as it is.
  void add(const nlohmann::ordered_json& event);
  /// Adds that a block of a view begins, and the load average at that moment.
  void begin_block(const std::string& view, int block, double load);
  void set_throttling(const Throttling& throttling);
  void end(const std::string& time_utc);

 private:
  explicit RunLog(std::filesystem::path folder) : folder_(std::move(folder)), lock_(folder_) {}

  std::filesystem::path folder_;
  FolderLock lock_;
  std::optional<GrowingFile> file_;
};

/// Calls `visit` with each event of the log in a folder, in order; returns the bytes of its whole
/// lines. Throws like `read_run`.
std::uint64_t for_each_event(const std::filesystem::path& folder,
                             const std::function<void(const nlohmann::ordered_json& event)>& visit);

/// Returns the difference between the programs of two manifests that makes their cells
/// incomparable, as a clause: the program, the plug-ins or a scene that both have; empty if there
/// is none.
std::string program_difference(const nlohmann::ordered_json& first,
                               const nlohmann::ordered_json& second);

/// Throws InputError when the run in `folder` was made with another configuration, by another
/// program or machine, with other plug-ins or with a scene that has changed since: its cells and
/// new ones would not be comparable. The reason is named.
void require_same_run(const std::filesystem::path& folder, const Run& run,
                      const nlohmann::json& config, const nlohmann::ordered_json& manifest);

}  // namespace beambench::measure

#pragma once
// The log of a run, run.jsonl: the record from which all other files in its folder are made.
//
// One JSON object per line, in the order of events; lines are never rewritten:
//   header        schema_version, manifest, config, plan: index and name of each cell
//   resumed       manifest: the run continues in another process
//   tuning        parameter sets of a view's tuned contenders: camera, times, the cells kept
//   block         a new process measures the contenders of a view: block number, load
//   cell          the timing of a cell begins: its identity, rays, counters and sizes;
//                 in logs without repetitions also `columns`: figures made from them
//   repetition    a timed repetition of a cell, in a block, with its second trace
//   verification  the classes of the hits of a cell's first repetition
//   warning       a sentence about a condition that could not be controlled
//   throttling    the throttling of the run so far, including the parts before it was resumed
//   finished      a cell needs no more repetitions: verdict, reason, message, examples
//   end           every cell is finished
// Cells are identified by their `index` in the plan of the whole sweep.

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

/// The version of the log. Incremented when programs made for the old version would fail. Version 1
/// had no blocks: its repetitions all come from one process.
inline constexpr int kLogVersion = 2;

/// The name of the log in a run's folder.
inline constexpr const char* kLogName = "run.jsonl";
/// The name of a log compressed with gzip for archiving; it is read if the uncompressed log is
/// missing.
inline constexpr const char* kPackedLogName = "run.jsonl.gz";

/// A cell of a plan.
struct PlannedName {
  std::size_t index;  ///< in the plan of the whole sweep
  std::string name;   ///< as from `CellId::name`
};

/// A run as recorded in its log.
struct Run {
  /// The manifest, updated by later events: warnings, throttling, the end.
  nlohmann::ordered_json manifest;
  nlohmann::json config;
  std::vector<PlannedName> plan;         ///< without the cells that tuning dropped
  std::vector<PlannedName> passed_over;  ///< dropped by tuning: other parameter sets were faster
  /// The cells that were begun, in the order of the plan. An unfinished cell has the verdict of its
  /// verification; before the verification it is absent.
  std::vector<CellRecord> cells;
  std::uint64_t log_bytes = 0;  ///< size of the whole lines of the log

  bool is_ended() const { return manifest.at("finished_utc").is_string(); }
};

/// Reads the log in a folder, up to its last whole line; a killed run may leave a partial one.
/// Throws InputError if the log is missing or cannot be read, naming the first invalid line.
Run read_run(const std::filesystem::path& folder);

/// Throws InputError if a folder does not contain a run that could be resumed.
void require_run(const std::filesystem::path& folder);

/// Writes the log of a run. Each event has been passed to the system when its function returns;
/// only the header is also synced to disk. Only one process at a time may use a folder. All
/// functions throw InputError if the log cannot be written; the log then ends with its last event.
class RunLog {
 public:
  /// Creates a folder for a new run; throws InputError if it already contains one.
  static RunLog create(const std::filesystem::path& folder);
  /// Opens the folder of a run to resume or read; throws InputError if it does not contain one.
  static RunLog open(const std::filesystem::path& folder);

  const std::filesystem::path& folder() const { return folder_; }

  /// Writes the header of a new run.
  void begin(const nlohmann::ordered_json& manifest, const nlohmann::json& config,
             std::span<const PlannedName> plan);
  /// Continues an opened log after its whole lines, which have `log_bytes` bytes.
  void resume(const nlohmann::ordered_json& manifest, std::uint64_t log_bytes);

  /// Adds an event: one of a cell (`CellEvents`), or an unchanged one from another log.
  void add(const nlohmann::ordered_json& event);
  /// Records that a block of a view begins, and the processors that others have kept busy so far;
  /// nothing: unknown.
  void begin_block(const std::string& view, int block, std::optional<double> other_work);
  void set_throttling(const Throttling& throttling);
  void end(const std::string& time_utc, std::optional<double> other_work = std::nullopt);

 private:
  explicit RunLog(std::filesystem::path folder) : folder_(std::move(folder)), lock_(folder_) {}

  std::filesystem::path folder_;
  FolderLock lock_;
  std::optional<GrowingFile> file_;
};

/// Calls `visit` with each event of the log in a folder, in order; returns the size of its whole
/// lines in bytes. Throws what `read_run` throws.
std::uint64_t for_each_event(const std::filesystem::path& folder,
                             const std::function<void(const nlohmann::ordered_json& event)>& visit);

/// Returns, as a clause, the difference between two manifests that makes their cells incomparable:
/// in the program, the plug-ins or a scene that both have. Empty if there is no such difference.
std::string program_difference(const nlohmann::ordered_json& first,
                               const nlohmann::ordered_json& second);

/// Throws InputError when the run in `folder` was made with another configuration, by another
/// program, on another machine, with other plug-ins or with a scene that has changed since: its
/// cells and new ones would not be comparable. The message states the reason.
void require_same_run(const std::filesystem::path& folder, const Run& run,
                      const nlohmann::json& config, const nlohmann::ordered_json& manifest);

}  // namespace beambench::measure

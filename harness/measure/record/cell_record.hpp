#pragma once
// The record of a cell: one structure tracing one set of rays.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "accel/core/statistics.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/verify/differ.hpp"

namespace beambench::measure {

enum class QueryPath {
  kImageSingle,  ///< an image, its rays generated one by one
  kImageSimd,    ///< an image, its rays generated and its hits stored by SIMD
  kImageOwn,     ///< an image sampled by the structure; the harness has no share
  kList,         ///< a list of rays: each is read, each result is written
  kListPacked,   ///< a list of rays, read and written by SIMD in packets
  kPicture       ///< a whole picture, which is shaded
};

/// The names of query paths in records.
inline constexpr std::array<std::string_view, 6> kQueryPathNames{
    "image-single", "image-simd", "image-own", "list", "list-packed", "picture"};

constexpr std::string_view to_string(QueryPath path) {
  return kQueryPathNames[static_cast<std::size_t>(path)];
}

/// The harness's own share of a trace by a query path: the time of the trace if finding the hits
/// costs nothing.
struct HarnessShare {
  QueryPath path;
  double ms;
};

/// The names of the events in column names, after the phase: `trace_instructions`.
inline constexpr std::array<std::string_view, 3> kHardwareEvents{"instructions", "cycles",
                                                                 "cache_misses"};

/// One count per event; nothing for events that this machine does not count.
using HardwareCounts = std::array<std::optional<std::uint64_t>, kHardwareEvents.size()>;

/// The identity of a cell within a sweep.
struct CellId {
  std::string scene;
  std::string camera;
  std::string structure;   ///< the bare name
  std::string parameters;  ///< all parameters, in canonical form
  rays::Resolution resolution;
  int samples;
  std::string rays;  ///< as in `RayChoice::label`

  /// Returns `escena1/default/320x200/1/primary/samet:max_level=6,max_objects=0`.
  std::string name() const;
  /// Returns the fingerprint of the name, sixteen hexadecimal digits.
  std::string key() const;
};

/// One timed repetition: built, traced, discarded.
struct Repetition {
  int round;     ///< contenders take turns: in a round, each makes one repetition
  int position;  ///< in the order of its group in that round
  double build_ms;
  double trace_ms;
  double build_cpu_ms;
  double trace_cpu_ms;
  HardwareCounts build_counts{};
  HardwareCounts trace_counts{};
  /// Time of a second trace of the same structure, which may have cached data from the first.
  std::optional<double> warm_trace_ms{};
  /// Time of the update to this frame, for a structure that was built over the scene's first frame.
  std::optional<double> update_ms{}, update_cpu_ms{};
  /// The clock rate of the core, measured just before and after.
  double clock_ghz = 1.0;
  /// The number of its block, a process that measures all contenders of its view; -1 in records of
  /// runs in one process.
  int block = -1;

  /// Returns whether the trace had the processor to itself: wall time and CPU time differ by at
  /// most 3%, or by at most 20 us, the time that reading the clocks may take. Traces that waited
  /// for another process are excluded.
  bool is_undisturbed() const {
    constexpr double kMaxPart = 0.03;
    constexpr double kMaxReading = 0.02;  // in milliseconds
    return trace_ms - trace_cpu_ms <= std::max(kMaxPart * trace_ms, kMaxReading);
  }

  /// Returns the time until tracing could begin: that of the update if there is one, otherwise that
  /// of the build.
  double ready_ms() const { return update_ms.value_or(build_ms); }
  double ready_cpu_ms() const { return update_cpu_ms.value_or(build_cpu_ms); }
  double total_ms() const { return ready_ms() + trace_ms; }
  /// Returns millions of clock cycles: a time that does not depend on the clock rate.
  double total_mcycles() const { return total_ms() * clock_ghz; }
};

/// The reason why repetitions ended.
enum class StopReason {
  kPrecision,   ///< as many blocks as the precision needs, estimated from the first block
  kBudget,      ///< the time is up
  kRepetitions  ///< the maximum is reached
};
std::string_view to_string(StopReason reason);  // "precision", "budget", "repetitions"

/// Facts shared by every row of a run.
struct RunFacts {
  std::string run_id;
  std::string commit;
  bool dirty;
  std::string machine_id;
  std::string build_type;
  std::string flags;
  std::string isa;
  int threads;
};

/// Facts shared by every cell of a group.
struct RaySetFacts {
  std::uint64_t scene_hash = 0;
  std::uint64_t rays_hash = 0;
  std::uint64_t seed = 0;  ///< of random rays; 0 if nothing is random
  std::uint64_t primitives = 0;
  std::uint64_t rays = 0;  ///< number of rays; 0 if they could not be generated
  rays::Query query = rays::Query::kClosestHit;
  /// The shares of closest-hit and any-hit queries that hit something, by the oracle.
  std::optional<double> hit_share{}, occluded_share{};
  std::optional<double> coherence{};  ///< between adjacent rays
};

/// Amounts of work by name.
using NamedCounters = std::map<std::string, std::uint64_t, std::less<>>;

/// Rays of one kind within a whole picture.
struct RaysOfKind {
  std::string kind;  ///< "camera", "reflected", "refracted", "shadow"
  std::uint64_t rays;
  NamedCounters counters;
};

/// The results of the counting pass.
struct CountedWork {
  NamedCounters counters;         ///< empty if the structure does not count
  std::vector<RaysOfKind> kinds;  ///< for a whole picture: the same counters, for each ray kind
};

/// A cell and all facts recorded about it.
struct CellRecord {
  std::size_t index;  ///< index in the plan of the whole sweep: the order of rows
  CellId id;
  RaySetFacts rays;
  int shard = 0;  ///< the shard that measured it; 0: not a merged run
  /// The number of its contender's parameter sets that were tried with the tuning camera
  /// (tuning.hpp); 1: measured without tuning.
  int parameter_sets = 1;
  std::string time_utc;      ///< time when it was finished
  bool is_finished = false;  ///< it needs no more repetitions

  CountedWork work;
  // Missing if the structure could not be built:
  std::optional<accel::Statistics> statistics;
  std::optional<std::uint64_t> allocated_bytes;   ///< growth of the heap (`heap_in_use`)
  std::optional<std::uint64_t> peak_build_bytes;  ///< peak memory of the build minus that before it
  std::optional<HarnessShare> harness;
  std::vector<Repetition> repetitions;
  /// Figures, by column of results.csv, that cannot be computed from the repetitions in the record.
  std::map<std::string, double, std::less<>> columns;
  std::optional<StopReason> stop_reason;
  /// The verification of the timed buffer, and the buffer's fingerprint.
  std::optional<verify::DiffReport> diff;
  std::optional<std::uint64_t> hits_hash;

  verify::Verdict verdict = verify::Verdict::kError;
  std::string message;                ///< what is wrong, in one sentence; empty if nothing is wrong
  std::vector<std::string> examples;  ///< descriptions of disputed rays

  /// Returns whether times are reported: only if the hits are correct, or missing by design.
  bool keeps_times() const { return verify::is_right(verdict); }
  bool has_times() const { return keeps_times() && !repetitions.empty(); }
  /// Returns a figure of `columns`; nothing if it is missing.
  std::optional<double> column(std::string_view name) const {
    const auto found = columns.find(name);
    return found == columns.end() ? std::nullopt : std::optional(found->second);
  }
};

/// Returns one figure, a member of `Repetition`, of every repetition of a cell.
template <class Figure>
std::vector<double> collect(const CellRecord& cell, Figure figure) {
  std::vector<double> values;
  values.reserve(cell.repetitions.size());
  for (const Repetition& repetition : cell.repetitions) {
    values.push_back(std::invoke(figure, repetition));
  }
  return values;
}

/// Returns the times of all second traces, in milliseconds.
std::vector<double> second_traces(const CellRecord& cell);

}  // namespace beambench::measure

#pragma once
// The record of one cell: one structure traced with one set of rays.

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
  kImageSingle,  ///< an image, its rays made one by one
  kImageSimd,    ///< an image, its rays made and its hits stored by SIMD
  kImageOwn,     ///< an image, by the structure's own samples: no share is the harness's
  kList,         ///< a list of rays: each is read, each answer is written
  kListPacked,   ///< the same, by SIMD, in packets
  kPicture       ///< a whole picture, which is shaded
};

/// The names of query paths in records.
inline constexpr std::array<std::string_view, 6> kQueryPathNames{
    "image-single", "image-simd", "image-own", "list", "list-packed", "picture"};

constexpr std::string_view to_string(QueryPath path) {
  return kQueryPathNames[static_cast<std::size_t>(path)];
}

/// The harness's own share of a trace by a path: the time it takes where results cost nothing.
struct HarnessShare {
  QueryPath path;
  double ms;
};

/// The names of the events in columns, after the phase: `trace_instructions`.
inline constexpr std::array<std::string_view, 3> kHardwareEvents{"instructions", "cycles",
                                                                 "cache_misses"};

/// One count for each event; nothing for an event that this machine does not count.
using HardwareCounts = std::array<std::optional<std::uint64_t>, kHardwareEvents.size()>;

/// The identity of a cell within a sweep.
struct CellId {
  std::string scene;
  std::string camera;
  std::string structure;   ///< the bare name
  std::string parameters;  ///< all of them, canonical
  rays::Resolution resolution;
  int samples;
  std::string rays;  ///< as `RayChoice::label`

  /// Returns `escena1/default/320x200/1/primary/samet:max_level=6,max_objects=0`.
  std::string name() const;
  /// Returns the fingerprint of the name, sixteen hexadecimal digits.
  std::string key() const;
};

/// One timed repetition: built, traced, thrown away.
struct Repetition {
  int round;     ///< contenders take turns, one repetition each a round
  int position;  ///< in the order of its group in that round
  double build_ms;
  double trace_ms;
  double build_cpu_ms;
  double trace_cpu_ms;
  HardwareCounts build_counts{};
  HardwareCounts trace_counts{};
  /// A second trace of the same structure, which may have kept data from the first.
  std::optional<double> warm_trace_ms{};
  /// Of a structure that was built over the scene's first frame: of its update to this one.
  std::optional<double> update_ms{}, update_cpu_ms{};
  /// The rate of the core's clock, measured just before and after.
  double clock_ghz = 1.0;
  /// The process in which it was made, with all contenders of its view; -1 in records of one
  /// process for a whole run.
  int block = -1;

  /// Returns whether the trace had its processor for itself: its wall time and its CPU time differ
  /// by at most 3%, or by less than 20 us, which reading the clocks takes. A trace that waited for
  /// another process is set aside.
  bool is_undisturbed() const {
    constexpr double kMaxPart = 0.03;
    constexpr double kMaxReading = 0.02;  // in milliseconds
    return trace_ms - trace_cpu_ms <= std::max(kMaxPart * trace_ms, kMaxReading);
  }

  /// Returns the time until it could be traced: of its build, or of its update.
  double ready_ms() const { return update_ms.value_or(build_ms); }
  double ready_cpu_ms() const { return update_cpu_ms.value_or(build_cpu_ms); }
  double total_ms() const { return ready_ms() + trace_ms; }
  /// Returns millions of clock cycles: a time that does not depend on the clock's rate.
  double total_mcycles() const { return total_ms() * clock_ghz; }
};

/// The reason why no further repetition was made.
enum class StopReason {
  kPrecision,   ///< as many blocks as the precision needs, by the first one
  kBudget,      ///< the time was up
  kRepetitions  ///< as many as were allowed
};
std::string_view to_string(StopReason reason);  // "precision", "budget", "repetitions"

/// The facts that every row of a run has in common.
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

/// The facts that every cell of a group has in common.
struct RaySetFacts {
  std::uint64_t scene_hash = 0;
  std::uint64_t rays_hash = 0;
  std::uint64_t seed = 0;  ///< of a random set of rays; 0 where nothing is random
  std::uint64_t primitives = 0;
  std::uint64_t rays = 0;  ///< 0 where they could not be made
  rays::Query query = rays::Query::kClosestHit;
  /// The shares of the closest-hit and of the any-hit queries that hit, by the oracle.
  std::optional<double> hit_share{}, occluded_share{};
  std::optional<double> coherence{};  ///< between neighbors
};

/// Work by name.
using NamedCounters = std::map<std::string, std::uint64_t, std::less<>>;

/// Rays of one kind within a whole picture.
struct RaysOfKind {
  std::string kind;  ///< "camera", "reflected", "refracted", "shadow"
  std::uint64_t rays;
  NamedCounters counters;
};

/// The results of the counting pass.
struct CountedWork {
  NamedCounters counters;         ///< empty where the structure counts nothing
  std::vector<RaysOfKind> kinds;  ///< of a whole picture: the same kind by kind
};

/// A cell and everything that was found out about it.
struct CellRecord {
  std::size_t index;  ///< in the plan of the whole sweep: the order of rows
  CellId id;
  RaySetFacts rays;
  int shard = 0;  ///< that measured it; 0: the run is no merged one
  /// The number of its contender's parameter sets that were tried on the tuning camera
  /// (tuning.hpp); 1: it was measured as it was given.
  int parameter_sets = 1;
  std::string time_utc;      ///< when it was finished
  bool is_finished = false;  ///< it needs no further repetition

  CountedWork work;
  // Absent where the structure could not be built:
  std::optional<accel::Statistics> statistics;
  std::optional<std::uint64_t> allocated_bytes;   ///< by which the heap grew (`heap_in_use`)
  std::optional<std::uint64_t> peak_build_bytes;  ///< of memory, in the build, above that before it
  std::optional<HarnessShare> harness;
  std::vector<Repetition> repetitions;
  /// Figures that the repetitions, or what is left of them, do not give: by columns of results.csv.
  std::map<std::string, double, std::less<>> columns;
  std::optional<StopReason> stop_reason;
  /// The verification of the timed buffer, and its fingerprint.
  std::optional<verify::DiffReport> diff;
  std::optional<std::uint64_t> hits_hash;

  verify::Verdict verdict = verify::Verdict::kError;
  std::string message;                ///< what is wrong, in one sentence; empty when nothing is
  std::vector<std::string> examples;  ///< disputed rays, described

  /// Returns whether times are reported: only when the hits are correct, or absent by design.
  bool keeps_times() const { return verify::is_right(verdict); }
  bool has_times() const { return keeps_times() && !repetitions.empty(); }
  /// Returns a figure of `columns`; nothing where it is not there.
  std::optional<double> column(std::string_view name) const {
    const auto found = columns.find(name);
    return found == columns.end() ? std::nullopt : std::optional(found->second);
  }
};

/// Returns one figure of every repetition of a cell: a member of `Repetition`.
template <class Figure>
std::vector<double> collect(const CellRecord& cell, Figure figure) {
  std::vector<double> values;
  values.reserve(cell.repetitions.size());
  for (const Repetition& repetition : cell.repetitions) {
    values.push_back(std::invoke(figure, repetition));
  }
  return values;
}

/// Returns the second traces of the repetitions that have one, in milliseconds.
std::vector<double> second_traces(const CellRecord& cell);

}  // namespace beambench::measure

#pragma once
// One structure in the group of those that trace the same rays, and when it has been repeated
// enough.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/measure/google_benchmark.hpp"
#include "harness/measure/measurement.hpp"
#include "harness/measure/plan.hpp"
#include "harness/measure/record/cell_record.hpp"
#include "harness/measure/record/run_log.hpp"
#include "harness/measure/task.hpp"

namespace beambench::measure {

/// The instruments and conditions of a repetition.
struct Instruments {
  const GoogleBenchmark& benchmark;
  const HardwareCounters& counters;
  int core;     ///< to pin it to; -1: any
  int threads;  ///< that trace an image
};

/// A cell while it is measured. The differ verifies its first timed results, and those of every
/// other pass, including the counting one, must equal them bit for bit: so the verdict holds for
/// all results that a timed repetition wrote. Every fault of a structure is recorded and ends its
/// measurement; nothing is thrown.
class Contender {
 public:
  /// The first `second_traces` repetitions are followed by a second trace of the same structure.
  /// `earlier` is the record of the cell from an interrupted part of the run: its repetitions
  /// count, and its results must be the same.
  Contender(const PlannedCell& cell, Task& task, int second_traces,
            std::optional<CellRecord> earlier);

  /// Runs the untimed pass, for sizes and counters. Logs that the cell begins.
  void count(RunLog& log);
  /// Runs one timed repetition through Google Benchmark; the first ones are followed by a second
  /// trace. Logs it, and the first one's verification.
  void repeat(const Instruments& instruments, int round, int position, RunLog& log);

  const CellId& id() const { return cell_->id; }
  bool failed() const { return failed_; }
  int repetitions() const { return static_cast<int>(record_.repetitions.size()); }
  /// Returns the first round without any of its repetitions.
  int next_round() const {
    return record_.repetitions.empty() ? 0 : record_.repetitions.back().round + 1;
  }
  /// Returns the total of each repetition, as used to decide whether a figure is precise: for the
  /// median millions of cycles, because the clock's rate changes; for the minimum milliseconds,
  /// because a rate that was read in a disturbed moment makes the cycles too few.
  std::span<const double> totals(Figure figure) const {
    return figure == Figure::kMinimum ? milliseconds_ : cycles_;
  }
  /// Returns the time spent, including warm traces.
  double spent_ms() const { return spent_ms_; }
  /// Returns the finished cell.
  CellRecord finish(std::optional<StopReason> reason) &&;

 private:
  /// Leaves the structure that it built in `structure`.
  Repetition time_once(const Instruments& instruments,
                       std::unique_ptr<accel::Accelerator>& structure);
  void keep(const Repetition& repetition);
  void check_answers(const accel::Accelerator& structure);
  void trace_warm(const accel::Accelerator& structure);
  void verify_first(const accel::Accelerator& structure);
  void fail(verify::Verdict verdict, std::string message);

  const PlannedCell* cell_;
  Task* task_;
  std::size_t second_traces_;
  CellRecord record_;
  std::vector<double> cycles_;
  std::vector<double> milliseconds_;
  double spent_ms_ = 0.0;
  std::uint64_t counted_hits_ = 0;  ///< fingerprint of the counting pass's answers
  bool failed_ = false;
  bool is_verified_ = false;  ///< have this process's answers been compared with the oracle's?
};

struct StoppingRule {
  double precision;  ///< wanted half-width of the interval of a repeat, relative to the figure
  Figure precise;    ///< the figure that is to be that precise
  int minimum;       ///< repetitions that are made in any case
  int maximum;
};

/// Returns whether the precision is tested after that many repetitions: at the minimum, then each
/// time a quarter more have been made. A test after each one would stop at a lucky moment, when the
/// interval happens to be narrower than it should.
bool is_look(int repetitions, int minimum);

/// Returns why to stop, or nothing while another repetition is due. `totals` are those of the
/// repetitions, `spent_ms` is the time they took, `allowance_ms` the cell's share of the budget,
/// which the minimum of repetitions may exceed. The precision is reached when `repeat_interval` of
/// the median, or `repeat_spread_of_minimum`, is known and narrow.
std::optional<StopReason> reason_to_stop(std::span<const double> totals, double spent_ms,
                                         double allowance_ms, const StoppingRule& rule);

}  // namespace beambench::measure

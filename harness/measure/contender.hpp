#pragma once
// One structure in the group of those that trace the same rays.

#include <cstdint>
#include <memory>
#include <string>

#include "harness/measure/google_benchmark.hpp"
#include "harness/measure/measurement.hpp"
#include "harness/measure/plan.hpp"
#include "harness/measure/record/cell_events.hpp"
#include "harness/measure/record/cell_record.hpp"
#include "harness/measure/task.hpp"

namespace beambench::measure {

/// The instruments and conditions of a repetition.
struct Instruments {
  const GoogleBenchmark& benchmark;
  const HardwareCounters& counters;
  int core;     ///< to pin it to; -1: any
  int threads;  ///< that trace an image
  int block;    ///< that is being measured
};

/// A cell while it is measured. The differ verifies its first timed results, and those of every
/// other pass, including the counting one and those of other blocks, must equal them bit for bit:
/// so the verdict holds for all results that a timed repetition wrote. Every fault of a structure
/// is recorded and ends its measurement; nothing is thrown.
class Contender {
 public:
  /// The first `second_traces` repetitions are followed by a second trace of the same structure.
  /// `earlier` is the record of the cell from earlier blocks: its repetitions count, and its
  /// results must be the same.
  Contender(const PlannedCell& cell, Task& task, int second_traces, CellRecord earlier);

  /// Runs the untimed pass, for sizes and counters. Writes that the cell begins, and that it is
  /// finished where the structure fails.
  void count(const CellEvents& events);
  /// Runs one timed repetition through Google Benchmark; the first ones are followed by a second
  /// trace. Writes it, and the first one's verification; where the structure fails, that the cell
  /// is finished.
  void repeat(const Instruments& instruments, int round, int position, const CellEvents& events);

  const CellId& id() const { return cell_->id; }
  bool failed() const { return failed_; }
  const CellRecord& record() const { return record_; }

 private:
  /// Leaves the structure that it built in `structure`.
  Repetition time_once(const Instruments& instruments,
                       std::unique_ptr<accel::Accelerator>& structure);
  void check_answers(const accel::Accelerator& structure);
  void trace_warm(const accel::Accelerator& structure);
  void verify_first(const accel::Accelerator& structure);
  void fail(verify::Verdict verdict, std::string message);
  void finish(const CellEvents& events);

  const PlannedCell* cell_;
  Task* task_;
  std::size_t second_traces_;
  CellRecord record_;
  std::uint64_t counted_hits_ = 0;  ///< fingerprint of the counting pass's answers
  bool failed_ = false;
};

}  // namespace beambench::measure

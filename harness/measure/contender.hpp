#pragma once
// A contender: one of the structures that trace the same rays.

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

/// The instruments and conditions for a repetition.
struct Instruments {
  const GoogleBenchmark& benchmark;
  const HardwareCounters& counters;
  int core;     ///< the core to pin to; -1: any
  int threads;  ///< number of threads that trace an image
  int block;    ///< the block being measured
};

/// A cell while it is measured. The differ verifies its first timed results. The results of every
/// other pass, including the counting pass and other blocks, must equal them bit for bit, so the
/// verdict holds for all timed results. A structure's errors are recorded and end its measurement;
/// they are never thrown.
class Contender {
 public:
  /// The first `second_traces` repetitions are followed by a second trace of the same structure.
  /// `earlier` is the cell's record from earlier blocks: the repetitions in it count, and new
  /// results must equal those in it.
  Contender(const PlannedCell& cell, Task& task, int second_traces, CellRecord earlier);

  /// Runs the untimed counting pass, which determines sizes and counters. Writes the start of the
  /// cell and, if the structure fails, its end.
  void count(const CellEvents& events);
  /// Runs one timed repetition through Google Benchmark; the first repetitions are followed by a
  /// second trace. Writes the repetition, the verification after the first repetition and, if the
  /// structure fails, the end of the cell.
  void repeat(const Instruments& instruments, int round, int position, const CellEvents& events);

  const CellId& id() const { return cell_->id; }
  bool failed() const { return failed_; }
  const CellRecord& record() const { return record_; }

 private:
  /// Builds and traces once; leaves the structure that it builds in `structure`.
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
  std::uint64_t counted_hits_ = 0;  ///< fingerprint of the counting pass's results
  bool failed_ = false;
};

}  // namespace beambench::measure

#pragma once
// One structure in the group of those that are asked with the same rays.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/differ/differ.hpp"
#include "harness/rays/answers.hpp"
#include "harness/record/cell_record.hpp"
#include "harness/sweep/google_benchmark.hpp"
#include "harness/sweep/hardware_counters.hpp"
#include "harness/sweep/plan.hpp"

namespace beambench {

/// What a repetition is measured with.
struct Instruments {
  const GoogleBenchmark& benchmark;
  const HardwareCounters& counters;
  int core;  ///< to pin it to; -1: any
};

/// What the contenders of a group share: the rays, the oracle's hits, and room for one set of
/// answers, since they take turns.
class SharedQuestion {
 public:
  /// The group outlives it; `core` is to measure the harness's own time on. Throws as
  /// `make_question`.
  SharedQuestion(const CellGroup& group, std::uint64_t scene_hash, int core);
  SharedQuestion(const SharedQuestion&) = delete;
  SharedQuestion& operator=(const SharedQuestion&) = delete;

  const Scene& scene() const { return reference_.scene(); }
  ImageOfRays image() const { return group_->image(); }
  const Question& question() const { return reference_.question(); }
  Workload workload() const { return workload_of(image(), question()); }
  const ReferenceHits& reference() const { return reference_; }
  const RaySetFacts& facts() const { return facts_; }
  Answers& answers() { return answers_; }

 private:
  const CellGroup* group_;
  ReferenceHits reference_;
  RaySetFacts facts_;
  Answers answers_;
};

/// A cell while it is measured. Its first timed answers are judged by the differ, and those of
/// every other pass, the counting one included, must equal them bit for bit: so the verdict speaks
/// of all answers that a timed repetition wrote. Whatever a structure does wrong is noted here and
/// ends its measurement; nothing is thrown.
class Contender {
 public:
  Contender(const PlannedCell& cell, SharedQuestion& question);

  /// The untimed pass: sizes and counters.
  void count();
  /// One timed repetition, run through Google Benchmark; the first `kWarmTraces` times followed by
  /// a second trace of the same structure.
  void repeat(const Instruments& instruments, int round, int position);

  static constexpr std::size_t kWarmTraces = 5;

  bool failed() const { return failed_; }
  /// Total cycles of each repetition, in millions.
  std::span<const double> cycles() const { return cycles_; }
  /// Warm traces included.
  double spent_ms() const { return spent_ms_; }
  /// The finished cell.
  CellRecord finish(std::optional<StopReason> reason) &&;

 private:
  /// Leaves the structure that it built in `structure`.
  Repetition time_once(const Instruments& instruments, std::unique_ptr<Accelerator>& structure);
  void examine();
  void trace_warm(const Accelerator& structure);
  void judge_first();
  void fail(std::string verdict, std::string message);

  const PlannedCell* cell_;
  SharedQuestion* question_;
  CellRecord record_;
  std::vector<double> cycles_;
  double spent_ms_ = 0.0;
  std::uint64_t counted_hits_ = 0;  ///< fingerprint of the counting pass's answers
  bool failed_ = false;
};

}  // namespace beambench

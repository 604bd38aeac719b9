#pragma once
// One structure in the group of those that are asked with the same rays.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "accel/primary_rays.hpp"
#include "harness/differ/differ.hpp"
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

/// What the contenders of a group share: the rays, the oracle's answers, and one buffer, since they
/// take turns.
class SharedQuestion {
 public:
  /// The group's scene outlives it.
  SharedQuestion(const CellGroup& group, std::uint64_t scene_hash);
  SharedQuestion(const SharedQuestion&) = delete;
  SharedQuestion& operator=(const SharedQuestion&) = delete;

  const Scene& scene() const { return *scene_; }
  const PrimaryRays& rays() const { return rays_; }
  const ReferenceHits& reference() const { return reference_; }
  const RaySetFacts& facts() const { return facts_; }
  HitBuffer& buffer() { return buffer_; }

 private:
  const Scene* scene_;
  PrimaryRays rays_;
  ReferenceHits reference_;
  RaySetFacts facts_;
  HitBuffer buffer_;
};

/// A cell while it is measured. Its first timed buffer is judged by the differ, and the buffer of
/// every other pass, the counting one included, must equal it bit for bit: so the verdict speaks of
/// each buffer that a timed repetition wrote. Whatever a structure does wrong is noted here and
/// ends its measurement; nothing is thrown.
class Contender {
 public:
  Contender(const PlannedCell& cell, SharedQuestion& question);

  /// The untimed pass: sizes and counters.
  void count();
  /// One timed repetition, run through Google Benchmark.
  void repeat(const Instruments& instruments, int round, int position);

  bool failed() const { return failed_; }
  std::span<const double> totals_ms() const { return totals_ms_; }
  double spent_ms() const { return spent_ms_; }
  /// The finished cell.
  CellRecord finish(std::optional<StopReason> reason) &&;

 private:
  Repetition time_once(const Instruments& instruments);
  void examine();
  void judge_first();
  void fail(std::string verdict, std::string message);

  const PlannedCell* cell_;
  SharedQuestion* question_;
  CellRecord record_;
  std::vector<double> totals_ms_;
  double spent_ms_ = 0.0;
  std::uint64_t counted_hits_ = 0;  ///< fingerprint of the counting pass's buffer
  bool failed_ = false;
};

}  // namespace beambench

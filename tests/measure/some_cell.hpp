#pragma once
// A finished cell whose numbers have simple sums.

#include "harness/measure/record/cell_record.hpp"

namespace beambench::measure {

inline CellRecord some_cell() {
  CellRecord cell{};
  cell.id = {"tetra:n=2", "default", "samet", "max_level=6", {32, 20}, 1, "primary"};
  cell.rays = {1, 2, 0, 16, 640};
  cell.rays.hit_share = 0.5;
  cell.rays.coherence = 0.9;
  cell.verdict = verify::Verdict::kOk;
  cell.statistics.emplace();
  cell.statistics->nodes = 9;
  cell.harness = {QueryPath::kImageSingle, 2.5};
  cell.work.counters = {{"traversal_steps", 1280}, {"clips", 64}};
  cell.allocated_bytes = 4096;
  cell.peak_build_bytes = 8192;
  cell.stop_reason = StopReason::kPrecision;
  cell.diff = verify::DiffReport{};
  for (int round = 0; round < 7; ++round) {
    cell.repetitions.push_back({round, 0, 1.0 + round, 10.0, 1.0, 9.0, {}, {}});
    cell.repetitions.back().trace_counts = {1000U + static_cast<unsigned>(round), 500,
                                            std::nullopt};
  }
  return cell;
}

}  // namespace beambench::measure

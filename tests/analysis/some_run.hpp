#pragma once
// Runs with given times, in the form of their logs.

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/measure/record/run_log.hpp"

namespace beambench::analysis {

/// A structure in a view, with its times.
struct Entrant {
  std::string structure;
  std::vector<double> trace_ms;  ///< of each block, which has one repetition
  double build_ms = 1.0;
  std::string parameters{};
  verify::Verdict verdict = verify::Verdict::kOk;
};

/// Returns a finished cell: `rays` rays in ten rows.
inline measure::CellRecord cell_of(const Entrant& entrant, const std::string& scene = "escena1",
                                   std::uint64_t rays = 1000) {
  measure::CellRecord cell{};
  cell.id = {
      scene, "default", entrant.structure, entrant.parameters, {static_cast<int>(rays / 10), 10},
      1,     "primary"};
  cell.rays.rays = rays;
  cell.rays.primitives = 400;
  cell.time_utc = "2026-01-01T00:00:00Z";
  cell.is_finished = true;
  cell.verdict = entrant.verdict;
  for (const double trace_ms : entrant.trace_ms) {
    measure::Repetition repetition{};
    repetition.round = static_cast<int>(cell.repetitions.size());
    repetition.build_ms = entrant.build_ms;
    repetition.trace_ms = repetition.trace_cpu_ms = trace_ms;
    repetition.block = repetition.round;
    repetition.clock_ghz = 3.0;
    cell.repetitions.push_back(repetition);
  }
  if (entrant.trace_ms.empty()) {
    cell.message = "two hits are wrong";
  } else {
    cell.stop_reason = measure::StopReason::kPrecision;
    cell.diff.emplace().verdict = entrant.verdict;
    cell.hits_hash = 1;
  }
  return cell;
}

/// Returns a cell as records of one process have it, without blocks.
inline measure::CellRecord of_one_process(measure::CellRecord cell) {
  for (measure::Repetition& one : cell.repetitions) one.block = -1;
  return cell;
}

/// Returns the manifest of a finished run on a quiet machine.
inline nlohmann::ordered_json quiet_manifest() {
  return {{"run_id", "20260101-000000.000-test"},
          {"time_utc", "2026-01-01T00:00:00Z"},
          {"finished_utc", "2026-01-01T01:00:00Z"},
          {"program",
           {{"commit", "abc"}, {"dirty", false}, {"build_type", "Release"}, {"flags", "-O3"}}},
          {"machine", {{"id", "0123456789abcdef"}}},
          {"measurement",
           {{"isa", "AVX2"}, {"threads", 1}, {"noise", nullptr}, {"throttling", nullptr}}},
          {"uncontrolled", nlohmann::ordered_json::array()}};
}

/// Returns a run of exactly these cells, in this order.
inline measure::Run run_of(std::vector<measure::CellRecord> cells,
                           nlohmann::json config = nlohmann::json::object()) {
  measure::Run run{quiet_manifest(), std::move(config), {}, {}, std::move(cells)};
  for (std::size_t i = 0; i < run.cells.size(); ++i) {
    run.cells[i].index = i;
    run.plan.push_back({i, run.cells[i].id.name()});
  }
  return run;
}

/// Returns eight nearly equal times.
inline std::vector<double> rounds(double ms) {
  return {ms, ms * 1.01, ms * 0.99, ms, ms * 1.02, ms, ms, ms * 0.98};
}

}  // namespace beambench::analysis

// Simulated runs: whether an unsteady machine is detected.

#include "harness/analysis/steadiness.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "scenes/base/random.hpp"
#include "tests/analysis/some_run.hpp"

namespace beambench::analysis {
namespace {

double normal(Random& random) {
  return std::sqrt(-2.0 * std::log(1.0 - random.unit())) * std::cos(2.0 * M_PI * random.unit());
}

/// Returns a run of twelve views with four contenders and eight blocks, whose processes differ by
/// 1.5%; its second half is slower by `shift`.
measure::Run simulated(Random& random, double shift) {
  constexpr int kBlocks = 8;
  std::vector<measure::CellRecord> cells;
  for (int view = 0; view < 12; ++view) {
    std::vector<double> process;
    for (int block = 0; block < kBlocks; ++block) process.push_back(0.015 * normal(random));
    for (int contender = 0; contender < 4; ++contender) {
      std::vector<double> times;
      for (int block = 0; block < kBlocks; ++block) {
        const double own = 0.01 * normal(random) + process[static_cast<std::size_t>(block)];
        times.push_back(std::exp(own + (block < kBlocks / 2 ? 0.0 : shift)));
      }
      cells.push_back(
          cell_of({fmt::format("s{}", contender), times}, fmt::format("scene{}", view)));
      for (measure::Repetition& one : cells.back().repetitions) {
        one.block = one.round;
        one.trace_cpu_ms = one.trace_ms;
      }
    }
  }
  return run_of(std::move(cells));
}

/// Returns the share of simulated runs that are called unsteady.
double alarms(double shift) {
  constexpr int kRuns = 1000;
  Random random(11);
  int unsteady = 0;
  for (int i = 0; i < kRuns; ++i) unsteady += !steadiness(simulated(random, shift))->is_steady();
  return static_cast<double>(unsteady) / kRuns;
}

TEST(Steadiness, OfASteadyMachineIsRejectedInOneRunOfTwenty) {
  const double share = alarms(0.0);
  EXPECT_GT(share, 0.03);
  EXPECT_LT(share, 0.07);  // 5%, and three standard errors of a thousand runs
}

TEST(Steadiness, AShiftOfThreePercentIsDetected) { EXPECT_GT(alarms(0.03), 0.9); }

TEST(Steadiness, NeedsFourBlocks) {
  EXPECT_FALSE(steadiness(run_of({cell_of({"samet", rounds(1.0)})}))) << "of one process";
}

}  // namespace
}  // namespace beambench::analysis

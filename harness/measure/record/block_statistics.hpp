#pragma once
// Statistics of blocks (harness/measure/block.hpp): the value of each block, and intervals of their
// mean.

#include <functional>
#include <map>
#include <optional>
#include <span>

#include "harness/measure/record/cell_record.hpp"
#include "harness/measure/record/robust_statistics.hpp"

namespace beambench::measure {

/// A time or a ratio, estimated from blocks.
struct Estimate {
  double value;  ///< geometric mean over the blocks
  /// Covers the true value with 95% confidence. Decides rankings. Nothing for fewer than two
  /// blocks.
  std::optional<Interval> confidence{};
  /// Covers the value of a second run with as many blocks with 95% probability. It is wider than
  /// the confidence interval by the square root of two, since both runs vary.
  std::optional<Interval> prediction{};
  std::optional<double> error{};  ///< standard error of the value's logarithm; needs two blocks
};

/// Returns the estimate for positive values with multiplicative variation: the mean of their
/// logarithms, with Student's t intervals. If the values were examined `looks` times, with more
/// values measured after each look, the intervals of all looks hold jointly with 95% confidence
/// (Bonferroni).
Estimate estimate(std::span<const double> values, int looks = 1);

/// Returns the 97.5% quantile of Student's t, which turns a standard error into the half-width of a
/// 95% interval; for several looks, the quantile with which all intervals hold jointly with 95%
/// confidence. `degrees` is at least 1.
double student_t(int degrees, int looks = 1);

/// The clock used to compare contenders.
enum class TraceClock {
  kWall,
  kCpu  ///< CPU time of the tracing thread; used if too many traces were disturbed
};

/// Returns a figure of a cell in each block: the least value of its undisturbed repetitions. Omits
/// blocks without an undisturbed repetition or without a positive value.
std::map<int, double> least_by_block(const CellRecord& cell,
                                     const std::function<double(const Repetition&)>& figure);

/// Returns the trace time of a cell in each block, in milliseconds: that of its fastest undisturbed
/// repetition (`Repetition::is_undisturbed`) or, by the CPU clock, that of its fastest repetition.
/// A block without an undisturbed repetition has no wall time.
std::map<int, double> trace_by_block(const CellRecord& cell, TraceClock clock);

/// Returns the total time of build and trace of a cell in each block, in the same way.
std::map<int, double> total_by_block(const CellRecord& cell, TraceClock clock);

/// Returns whether a cell has wall times in fewer than half of its blocks, too few to be compared
/// by them.
bool is_disturbed(const CellRecord& cell);

/// Returns the clock used for a cell that is not compared with others.
inline TraceClock own_clock(const CellRecord& cell) {
  return is_disturbed(cell) ? TraceClock::kCpu : TraceClock::kWall;
}

/// Returns the number of blocks after which the half-width of the prediction interval is expected
/// to be `precision` times the value. `spread` is the standard deviation of the logarithms of one
/// block's repetitions. The result is at least 2 and at most `maximum`.
int blocks_for_precision(double spread, double precision, int maximum);

/// Returns the standard deviation of the logarithms of a cell's undisturbed trace times; 0 for
/// fewer than two.
double spread_of(const CellRecord& cell);

}  // namespace beambench::measure

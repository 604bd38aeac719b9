#pragma once
// The statistics of blocks (harness/measure/block.hpp): a value for each, and the intervals of
// their mean.

#include <functional>
#include <map>
#include <optional>
#include <span>

#include "harness/measure/record/cell_record.hpp"
#include "harness/measure/record/robust_statistics.hpp"

namespace beambench::measure {

/// A time or a ratio, found from blocks.
struct Estimate {
  double value;  ///< geometric mean over the blocks
  /// Covers the true value with 95%. Decides rankings. None for fewer than two blocks.
  std::optional<Interval> confidence{};
  /// Covers the value of a second run of as many blocks with 95%: wider by the square root of two,
  /// since both runs vary.
  std::optional<Interval> prediction{};
  std::optional<double> error{};  ///< standard error of the value's logarithm, with two blocks
};

/// Returns the estimate of positive values that vary by factors: the mean of their logarithms, with
/// the intervals of Student's t. Where the values were looked at `looks` times, more having been
/// measured after each look, the intervals of all looks together have 95% (Bonferroni).
Estimate estimate(std::span<const double> values, int looks = 1);

/// Returns the 97.5% quantile of Student's t, by which a standard error becomes the half-width of a
/// 95% interval; of several looks, that by which all together have 95%. `degrees` from 1.
double student_t(int degrees, int looks = 1);

/// The clock by which contenders are compared.
enum class TraceClock {
  kWall,
  kCpu  ///< of the tracing thread; where other processes disturbed too many traces
};

/// Returns a figure of a cell in each block: that of its repetition with the least one, of those
/// that were not disturbed. A block without any, or where none is positive, is left out.
std::map<int, double> least_by_block(const CellRecord& cell,
                                     const std::function<double(const Repetition&)>& figure);

/// Returns the trace time of a cell in each block, in milliseconds: that of its fastest undisturbed
/// repetition (`Repetition::is_undisturbed`), or by the CPU clock its least. A block without an
/// undisturbed repetition has no wall time.
std::map<int, double> trace_by_block(const CellRecord& cell, TraceClock clock);

/// Returns the time of building and tracing of a cell in each block, likewise.
std::map<int, double> total_by_block(const CellRecord& cell, TraceClock clock);

/// Returns whether the wall times of a cell are too few to compare it by: those of less than half
/// of its blocks.
bool is_disturbed(const CellRecord& cell);

/// Returns the clock that serves for a cell by itself.
inline TraceClock own_clock(const CellRecord& cell) {
  return is_disturbed(cell) ? TraceClock::kCpu : TraceClock::kWall;
}

/// Returns the number of blocks after which the half-width of the prediction interval is expected
/// to be `precision` of the value, from the repetitions of one block, whose logarithms have the
/// standard deviation `spread`. At least 2, at most `maximum`.
int blocks_for_precision(double spread, double precision, int maximum);

/// Returns the standard deviation of the logarithms of a cell's undisturbed trace times; 0 for
/// fewer than two.
double spread_of(const CellRecord& cell);

}  // namespace beambench::measure

#pragma once
// Tests whether the machine was as fast late in a run as early. If it was not, no interval of the
// run can hold for another run.

#include <optional>

#include "harness/measure/record/run_log.hpp"

namespace beambench::analysis {

/// A comparison of the late blocks of a run with the early ones, over all cells.
struct Steadiness {
  double shift;  ///< mean shift of the logarithms of times: 0.03 if late blocks took 3% longer
  double limit;  ///< on a steady machine, |shift| stays below this in 95% of the runs

  bool is_steady() const { return shift <= limit && -shift <= limit; }
  /// Returns the part of the shift that chance does not explain, by which intervals of logarithms
  /// are widened.
  double excess() const { return is_steady() ? 0.0 : (shift < 0.0 ? -shift : shift) - limit; }
};

/// Compares the first half of the blocks with the second in each view that has at least four. The
/// value of a block is the mean of the logarithms of its contenders' times, each relative to the
/// contender's own mean. Pools the views and applies Student's t-test. Returns nothing if no view
/// has four blocks.
std::optional<Steadiness> steadiness(const measure::Run& run);

}  // namespace beambench::analysis

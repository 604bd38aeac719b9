#pragma once
// Whether the machine was as fast late in a run as early: no interval of a run can hold for another
// one where it was not.

#include <optional>

#include "harness/measure/record/run_log.hpp"

namespace beambench::analysis {

/// A comparison of the late blocks of a run with the early ones, over all cells.
struct Steadiness {
  double shift;  ///< of the logarithms of times: 0.03 where late blocks took 3% longer
  double limit;  ///< by which it differs from 0 by chance in 95% of the runs of a steady machine

  bool is_steady() const { return shift <= limit && -shift <= limit; }
  /// Returns what chance does not explain: intervals of logarithms are widened by it.
  double excess() const { return is_steady() ? 0.0 : (shift < 0.0 ? -shift : shift) - limit; }
};

/// Compares the first with the second half of the blocks of each view that has four or more, by the
/// mean of the logarithms of all its contenders' times, each relative to its own mean; pools the
/// views, and tests by Student's t. Nothing where no view has four blocks.
std::optional<Steadiness> steadiness(const measure::Run& run);

}  // namespace beambench::analysis

#pragma once
// Estimates in advance how long cells take to measure.

#include "harness/measure/config.hpp"
#include "harness/measure/plan.hpp"

namespace beambench::measure {

/// Returns the approximate number of rays of a group's task: exact for an image; for a picture, an
/// estimate from its lights and a few reflections.
double estimated_rays(const CellGroup& group);

/// Returns the approximate time of a group in nanoseconds: its rays and the oracle, and for each
/// cell the counting pass and the repetitions, for which a cell may use `allowance_ns` of the
/// sweep's budget. It may be wrong by a factor of a few, which suffices for dividing a sweep. It is
/// the same on every machine, bit for bit, because it uses only additions, multiplications and
/// divisions, and no functions of the C library, which may differ between processors.
double estimated_ns(const CellGroup& group, const SweepConfig& config, double allowance_ns);

}  // namespace beambench::measure

#pragma once
// How long cells take to measure, estimated before anything is measured.

#include "harness/measure/config.hpp"
#include "harness/measure/plan.hpp"

namespace beambench::measure {

/// How many rays a group's task has, about: exactly those of an image, and of a picture as many as
/// its lights and a few reflections make.
double estimated_rays(const CellGroup& group);

/// About how many nanoseconds a group takes: its rays and the oracle, and for each cell the
/// counting pass and the repetitions, where a cell may spend `allowance_ns` of the sweep's budget.
/// Right within a factor of a few, which is enough to divide a sweep. The same on every machine, to
/// the bit: it is made of additions, multiplications and divisions alone, without functions of the
/// C library, which may be others on another processor.
double estimated_ns(const CellGroup& group, const SweepConfig& config, double allowance_ns);

}  // namespace beambench::measure

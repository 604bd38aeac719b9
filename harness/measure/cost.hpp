#pragma once
// Estimates how long cells take to measure, before anything is measured.

#include "harness/measure/config.hpp"
#include "harness/measure/plan.hpp"

namespace beambench::measure {

/// Returns the approximate number of rays of a group's task: the exact number for an image, and for
/// a picture as many as its lights and a few reflections make.
double estimated_rays(const CellGroup& group);

/// Returns the approximate number of nanoseconds that a group takes: its rays and the oracle, and
/// for each cell the counting pass and the repetitions, where a cell may spend `allowance_ns` of
/// the sweep's budget. Correct within a factor of a few, which is enough to divide a sweep. The
/// same on every machine, bit for bit: it uses only additions, multiplications and divisions,
/// without functions of the C library, which may differ on another processor.
double estimated_ns(const CellGroup& group, const SweepConfig& config, double allowance_ns);

}  // namespace beambench::measure

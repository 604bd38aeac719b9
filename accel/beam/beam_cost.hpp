#pragma once
// Estimates the cost of beams, so that the octree's level can be chosen accordingly.

#include "accel/octree/choose_octree.hpp"

namespace beambench::accel::beam {

/// Estimates how many beams of a camera meet an empty leaf and how many end at an occupied one.
/// Traces beams through windows spread over the image; the windows are small if `expected` is large
/// relative to the number of rays. The estimate is unbiased. No sample is traced.
void count_beams(const octree::Octree& octree, const Workload& workload,
                 const octree::OctreeWork& expected, octree::OctreeWork& work);

/// Returns the expected nanoseconds of tracing by beams (thesis, section 5.3.3); see
/// `samet_trace_cost`. `handover` is the tracer's parameter.
double beam_trace_cost(const octree::OctreeWork& work, double handover);

}  // namespace beambench::accel::beam

#pragma once
// What beams are expected to cost, so that the octree's level can be chosen by it.

#include "accel/octree/choose_octree.hpp"

namespace beambench::accel::beam {

/// Estimates how many beams of a camera meet an empty leaf and how many end at an occupied one.
/// Traces beams through windows spread over the image, small ones where many beams are `expected`
/// for few rays; the estimate is unbiased. No sample is traced.
void count_beams(const octree::Octree& octree, const Workload& workload,
                 const octree::OctreeWork& expected, octree::OctreeWork& work);

/// Nanoseconds that tracing by beams is expected to take (thesis, section 5.3.3); see
/// `samet_trace_cost`. `handover` is the tracer's.
double beam_trace_cost(const octree::OctreeWork& work, double handover);

}  // namespace beambench::accel::beam

#pragma once
// What beams are expected to cost, so that the octree's level can be chosen by it.

#include "accel/octree/choose_octree.hpp"

namespace beambench {

/// Follows the beams of a camera and counts those that meet an empty leaf and those that end at an
/// occupied one. Beams do not depend on the resolution, and no sample is traced.
void count_beams(const Octree& octree, const Camera& camera, OctreeWork& work);

/// Nanoseconds that building the octree and tracing by beams are expected to take (thesis, section
/// 5.3.3); see `samet_cost`. `handover` is the tracer's.
double beam_cost(const OctreeWork& work, double handover);

}  // namespace beambench

#pragma once
// Sorts a list of rays, so that neighbors share nodes: what packets need, and what a renderer does
// before it traces them (Pharr and others, Rendering complex scenes with memory-coherent ray
// tracing, SIGGRAPH 1997).

#include "harness/rays/ray_set.hpp"
#include "scenes/scene.hpp"

namespace beambench::rays {

/// Sorts rays by direction, in 128 bins, and those of a bin by their origin's place along a Morton
/// curve through the bounds, of 1024 steps a side. Equals stay in order. Pencils are lost: their
/// rays are no longer neighbors.
void sort_rays(RayList& list, const scenes::Bounds& bounds);

}  // namespace beambench::rays

#pragma once
// Sorts a list of rays so that neighbors visit the same nodes. Packets need this, and renderers do
// it before tracing (Pharr and others, Rendering complex scenes with memory-coherent ray tracing,
// SIGGRAPH 1997).

#include "harness/rays/ray_set.hpp"
#include "scenes/scene.hpp"

namespace beambench::rays {

/// Sorts rays into 128 bins by direction. Within a bin, sorts them by their origin's place along a
/// Morton curve through the bounds, with 1024 steps a side. Equal rays stay in order. Pencils are
/// dropped, since their rays are no longer adjacent.
void sort_rays(RayList& list, const scenes::Bounds& bounds);

}  // namespace beambench::rays

#pragma once
// Refits hierarchies to primitives that have moved: the boxes change, the tree remains (Lauterbach,
// Yoon, Tuft and Manocha, "RT-DEFORM: interactive ray tracing of dynamic scenes using BVHs", 2006;
// Wald, Boulos and Shirley, "Ray tracing deformable scenes using dynamic bounding volume
// hierarchies", 2007).

#include "accel/bvh/insertion_hierarchy.hpp"
#include "accel/bvh/wide_bvh.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::bvh {

/// Computes the boxes of all volumes and objects from the scene's coordinates, and then the cost.
void refit(InsertionHierarchy& hierarchy, const scenes::Scene& scene);

/// Computes the boxes of all nodes, and copies the primitives' coordinates to the blocks. If
/// spatial splits have divided a primitive, each leaf that refers to it then holds all of it.
/// `parallel`: use all cores; the result is the same.
void refit(WideBvh& bvh, const scenes::Scene& scene, bool parallel);

}  // namespace beambench::accel::bvh

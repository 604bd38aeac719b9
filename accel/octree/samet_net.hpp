#pragma once
// Samet's traversal over linked neighbors.

#include "accel/octree/octree_net.hpp"
#include "accel/octree/octree_tracer.hpp"

namespace beambench::accel::octree {

/// Samet's traversal with the neighbors linked beforehand (Endl and Sommer, "Classification of
/// ray-generators in uniform subdivisions and octrees for ray tracing", Computer Graphics Forum
/// 13(1), 1994; thesis, section 5.4.1).
using SametNet = OctreeTracer<OctreeNet>;

}  // namespace beambench::accel::octree

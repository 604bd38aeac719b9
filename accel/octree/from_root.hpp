#pragma once
// Octrees traversed from the root: Glassner's search for each leaf, and Gargantini and Atkinson's
// descent into the children in order.

#include "accel/octree/box_cursor.hpp"
#include "accel/octree/hashed_octree.hpp"
#include "accel/octree/iterative_search.hpp"
#include "accel/octree/octree_cursor.hpp"
#include "accel/octree/octree_tracer.hpp"
#include "accel/octree/on_demand_octree.hpp"
#include "accel/octree/parametric_search.hpp"
#include "accel/octree/root_search.hpp"

namespace beambench::accel::octree {

/// Each traversal has four versions: for octrees with central planes, for those with arbitrary
/// planes, and, with either kind of planes, for octrees divided on demand and for hashed octrees.
///
/// Glassner's traversal (IEEE CG&A 4(10), 1984).
using Glassner = OctreeTracer<RootSearch<OctreeCursor>>;
using GlassnerAnyPlanes = OctreeTracer<RootSearch<BoxCursor>>;
using GlassnerOnDemand = OctreeTracer<RootSearch<OnDemandCursor>>;
using GlassnerHashed = OctreeTracer<RootSearch<HashedCursor>>;
using GlassnerIterative = OctreeTracer<IterativeSearch<OctreeCursor>>;
using GlassnerIterativeOnDemand = OctreeTracer<IterativeSearch<OnDemandCursor>>;
using GlassnerIterativeHashed = OctreeTracer<IterativeSearch<HashedCursor>>;

/// Gargantini and Atkinson's traversal (Computer Graphics Forum 12(4), 1993).
using Gargantini = OctreeTracer<ParametricSearch<OctreeCursor>>;
using GargantiniAnyPlanes = OctreeTracer<ParametricSearch<BoxCursor>>;
using GargantiniOnDemand = OctreeTracer<ParametricSearch<OnDemandCursor>>;
using GargantiniHashed = OctreeTracer<ParametricSearch<HashedCursor>>;

}  // namespace beambench::accel::octree

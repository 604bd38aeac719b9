#pragma once
// Chooses the planes between a node's children with the lowest heuristic cost.

#include <span>

#include <glm/vec3.hpp>

#include "accel/core/cell_grid.hpp"
#include "scenes/primitive.hpp"

namespace beambench::accel::octree {

/// Returns the planes, as finest cells, that divide the box of `size` cells (at least 2 along each
/// axis) at `corner`. MacDonald and Booth ("Heuristics for ray tracing using space subdivision",
/// The Visual Computer 6(3), 1990): a plane costs the areas of its two sides, each times the number
/// of objects there, and the best plane lies between the spatial median and the object median.
/// Whang and others ("Octree-R: an adaptive octree for efficient ray tracing", IEEE TVCG 1(4),
/// 1995) choose the plane of each axis this way. As in Havran's measurements (1999), 10 evenly
/// spaced positions between the medians are tried; if several have the lowest cost, the one nearest
/// to the spatial median is chosen. The object median is the median of the centers of the objects'
/// boxes, clipped by the node.
///
/// `ranges` has the cells of every primitive of the scene; `primitives` are the node's primitives.
glm::ivec3 cost_planes(const CellGrid& grid, const glm::ivec3& corner, const glm::ivec3& size,
                       std::span<const CellRange> ranges,
                       std::span<const scenes::PrimitiveId> primitives);

}  // namespace beambench::accel::octree

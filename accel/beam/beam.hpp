#pragma once
// A beam: a bundle of primary rays that pass through the same leaves of the octree.

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "accel/beam/crossing.hpp"
#include "accel/beam/image_polygon.hpp"
#include "accel/core/beam_outline.hpp"

namespace beambench::accel::beam {

/// A cut: the beam's rays cross `first` before `second`. `line` is the cut's image, negative
/// inside.
struct BeamCut {
  Crossing first;
  Crossing second;
  ImageLine line;
};

/// The pyramid from the eye through a convex polygon (thesis, section 3.2), as it enters a leaf.
///
/// The cuts alone decide which samples belong to the beam, by comparing numbers that every beam
/// computes in the same way for a ray (`crosses_before`). `outline` covers all of these samples.
/// Cuts that are not near the outline hold for all its samples and are dropped. So there are about
/// as many cuts as the outline has edges and, as in the thesis, the cost of a beam does not depend
/// on the resolution.
struct Beam {
  std::uint32_t node;  ///< the leaf's index in the octree
  std::int32_t size;   ///< length of the leaf's edges, in finest cells
  glm::ivec3 corner;   ///< the leaf's lowest finest cell
  ImagePolygon outline;
  FixedVector<BeamCut, 56> cuts;

  /// Returns whether there are too many cuts for one more division, which adds up to 5 cuts for the
  /// exit and 2 per level for the neighbors.
  bool crowded() const { return cuts.size() > 20; }
};

/// Returns the part of a beam on the inner side of all `cuts`: the clipped outline, with the old
/// and new cuts that are near it. If nothing is left, the outline is empty.
Beam part_of(const Beam& beam, std::span<const BeamCut> cuts);

}  // namespace beambench::accel::beam

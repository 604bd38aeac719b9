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

/// Rays of the beam cross `first` before `second`. `line` is its image, negative inside.
struct BeamCut {
  Crossing first;
  Crossing second;
  ImageLine line;
};

/// The pyramid from the eye through a convex polygon (thesis, section 3.2), where it enters a leaf.
///
/// Which samples belong to the beam is decided by the cuts alone, by one comparison of numbers
/// that every beam computes in the same way for a ray (`crosses_before`). `outline` covers them
/// all. Cuts that do not come near the outline hold for all its samples and are dropped, so that
/// there are about as many as the outline has edges, and as in the thesis a beam costs the same at
/// every resolution.
struct Beam {
  std::uint32_t node;  ///< the leaf, its index in the octree
  std::int32_t size;   ///< finest cells along the leaf's edges
  glm::ivec3 corner;   ///< its lowest finest cell
  ImagePolygon outline;
  FixedVector<BeamCut, 56> cuts;

  /// Too many cuts for one more division: it adds up to 5 for the exit and 2 per level for the
  /// neighbors.
  bool crowded() const { return cuts.size() > 20; }
};

/// The part of a beam on the inner side of all `cuts`: its outline clipped, those cuts kept, its
/// own and the new ones, that come near the new outline. The outline is empty when there is no
/// part.
Beam part_of(const Beam& beam, std::span<const BeamCut> cuts);

}  // namespace beambench::accel::beam

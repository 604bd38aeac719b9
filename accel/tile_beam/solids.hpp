#pragma once
// Closed surfaces whose backs no eye outside of them can see.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/large_pages.hpp"
#include "scenes/bounds.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::tile_beam {

/// Triangles that form a closed surface which every ray from `center` leaves through exactly one of
/// them: a star-shaped solid. A ray from an eye outside enters it before it leaves it, so that the
/// first hit on it is on a triangle that faces the eye.
struct Solid {
  scenes::Bounds box;
  glm::dvec3 center;  ///< of the box
  bool inward;        ///< seen from outside, the corners of its triangles go round clockwise
  std::uint32_t first_triangle;  ///< in `Solids::triangles`
  std::uint32_t triangle_count;
};

/// The solids that are found in a scene.
struct Solids {
  static constexpr std::uint32_t kNone = ~0U;

  std::vector<Solid> solids;
  LargePageVector<std::uint32_t> triangles;    ///< of the scene, solid by solid
  LargePageVector<std::uint32_t> of_triangle;  ///< the number of its solid, or kNone

  std::span<const std::uint32_t> triangles_of(const Solid& solid) const {
    return std::span(triangles).subspan(solid.first_triangle, solid.triangle_count);
  }
};

/// Finds solids in linear time: corners are matched by their bits, every edge has two triangles
/// that run along it in opposite directions, and the solid is what such edges connect. It is
/// star-shaped where all its triangles have the same sign of volume about the center and one ray
/// from there meets one of them: the projection of the surface to a sphere about the center then
/// covers it once. Surfaces of which rounding leaves this open are not solids.
Solids find_solids(const scenes::Scene& scene);

/// Is the eye outside by more than rounding? Where it is in the solid's box, finding out takes time
/// in proportion to the triangles; it is not done, and the answer is no, for more than
/// `most_triangles`.
bool is_outside(const scenes::Scene& scene, const Solids& solids, const Solid& solid,
                const glm::vec3& eye, std::size_t most_triangles);

}  // namespace beambench::accel::tile_beam

#pragma once
// Finds closed surfaces whose backs are invisible from outside.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/large_pages.hpp"
#include "scenes/bounds.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::tile_beam {

/// A star-shaped solid: triangles that form a closed surface such that every ray from `center`
/// leaves through exactly one of them. A ray from an eye outside enters the solid before leaving
/// it, so the first triangle that it hits faces the eye.
struct Solid {
  scenes::Bounds box;
  glm::dvec3 center;             ///< of the box
  bool inward;                   ///< seen from outside, the corners of its triangles are clockwise
  std::uint32_t first_triangle;  ///< in `Solids::triangles`
  std::uint32_t triangle_count;
};

/// The solids found in a scene.
struct Solids {
  static constexpr std::uint32_t kNone = ~0U;

  std::vector<Solid> solids;
  LargePageVector<std::uint32_t> triangles;    ///< of the scene, solid by solid
  LargePageVector<std::uint32_t> of_triangle;  ///< the number of its solid, or kNone

  std::span<const std::uint32_t> triangles_of(const Solid& solid) const {
    return std::span(triangles).subspan(solid.first_triangle, solid.triangle_count);
  }
};

/// Finds solids in linear time: corners are matched by their bits, and every edge must have two
/// triangles that run along it in opposite directions. The triangles connected by such edges form
/// the solid. It is star-shaped if the volumes of all its triangles about the center have the same
/// sign and one ray from the center meets exactly one triangle: the projection of the surface to a
/// sphere around the center then covers the sphere once. If rounding leaves this undecided, the
/// surface is not a solid.
Solids find_solids(const scenes::Scene& scene);

/// Returns whether the eye is outside by more than rounding. If the eye is in the solid's box, this
/// takes time proportional to the number of triangles; for more than `most_triangles`, returns
/// false instead.
bool is_outside(const scenes::Scene& scene, const Solids& solids, const Solid& solid,
                const glm::vec3& eye, std::size_t most_triangles);

}  // namespace beambench::accel::tile_beam

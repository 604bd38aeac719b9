#pragma once
// Hits that another program reports for a list of rays.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/primitive.hpp"

namespace beambench::rays {

/// Arrays with one element for each ray, in the order of the rays; missing arrays are empty. The
/// hits of closest-hit queries have `t` or `points` and, if the program provides ids, `primitives`
/// or `triangles`. Those of any-hit queries have only `occluded`.
struct ClaimedHits {
  std::span<const float> t{};           ///< the hit is at origin + t * direction; infinity: a miss
  std::span<const glm::vec3> points{};  ///< the point that is hit; infinite: a miss
  std::span<const std::uint32_t> primitives{};  ///< ids in `Scene::primitives`; kNoPrimitive: miss
  std::span<const std::uint32_t> triangles{};   ///< ids in `Scene::triangles`; kNoPrimitive: miss
  std::span<const std::uint8_t> occluded{};     ///< 1: the ray hits something; 0: nothing

  /// Returns the number of rays. Throws std::logic_error if the arrays differ in length, or do not
  /// match one of the forms above.
  std::size_t size() const;
  /// Returns the part for `count` rays, starting at `first`.
  ClaimedHits part(std::size_t first, std::size_t count) const;
};

/// Claimed hits that own their arrays.
struct HitTable {
  std::vector<float> t{};
  std::vector<glm::vec3> points{};
  std::vector<std::uint32_t> primitives{};
  std::vector<std::uint32_t> triangles{};
  std::vector<std::uint8_t> occluded{};

  ClaimedHits view() const { return {t, points, primitives, triangles, occluded}; }
};

}  // namespace beambench::rays

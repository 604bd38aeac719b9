#pragma once
// The one triangulation that defines a polygon's surface.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace beambench::scenes {

/// Returns whether `triangulate` makes a triangle from these three corners. If so, it is {0, 1, 2}.
bool has_area(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// Splits a simple polygon, convex or concave, into triangles by ear clipping (Meisters 1975) in
/// the coordinate plane in which its area (Newell's normal) is largest, computed in double from the
/// float corners; the time is about n log n. Deterministic: the same corners result in the same
/// triangles on every machine. Ears without area are dropped, so at most n - 2 triangles are
/// returned, each as three corner numbers in the polygon's winding order. A polygon without area
/// has no triangles. A self-intersecting polygon also gets triangles, but they are not meaningful.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const glm::vec3> corners);

}  // namespace beambench::scenes

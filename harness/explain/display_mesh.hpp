#pragma once
// The surfaces of a scene as triangles and spheres, for display.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/scene.hpp"

namespace beambench::explain {

/// Polygons and cones as triangles that share corners.
struct DisplayMesh {
  std::vector<glm::vec3> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into `corners`
  std::vector<scenes::PrimitiveId> primitives;          ///< one for each triangle
  std::size_t triangles_of_scene = 0;  ///< number of triangles before corners were merged
};

/// The maximum number of triangles that a page shows.
inline constexpr std::size_t kMostTriangles = 200'000;

/// Returns the polygons and cones of a scene; the viewer draws spheres itself. If there are more
/// than `most` triangles, merges corners in the same cell of a grid and drops degenerate triangles;
/// the grid is as fine as the limit permits.
DisplayMesh display_mesh(const scenes::Scene& scene, std::size_t most = kMostTriangles);

}  // namespace beambench::explain

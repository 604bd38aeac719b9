#pragma once
// The bumpy sphere as a mesh, which another scene breaks into parts.

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace beambench::scenes::generators {

/// Triangles over shared vertices, counter-clockwise as seen from outside.
struct BumpyMesh {
  std::vector<glm::dvec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Returns a closed, bumpy sphere of radius about 1. It has 12 k^2 triangles, for the k that brings
/// this number nearest to `triangles`.
BumpyMesh bumpy_mesh(std::int64_t triangles);

}  // namespace beambench::scenes::generators

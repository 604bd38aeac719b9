#pragma once
// From the triangles of a file to triangles that a scene can hold.

#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/formats/mesh/mesh.hpp"

namespace beambench::scenes::mesh {

/// Collects triangles as a file has them: vertices at the same place become one, unused ones go,
/// and triangles without area are left out and counted.
class MeshCollector {
 public:
  /// Triangles added from now on have this surface.
  void set_surface(const Surface& surface);
  /// Throws InputError naming the triangle when a coordinate is not a number from -1e9 to 1e9, or
  /// when there are too many for 32-bit indices.
  void add(const std::array<glm::vec3, 3>& corners);

  /// How many triangles were left out, and which was the first (counted from 0 as they were added).
  std::size_t degenerate() const { return degenerate_; }
  std::size_t first_degenerate() const { return first_degenerate_; }
  TriangleMesh finish() &&;

 private:
  std::uint32_t vertex(const glm::vec3& position);
  void grow();

  TriangleMesh mesh_;
  Surface surface_;
  std::vector<std::uint32_t> slots_;  // an open hash table of indices into mesh_.vertices
  std::size_t degenerate_ = 0;
  std::size_t first_degenerate_ = 0;
};

}  // namespace beambench::scenes::mesh

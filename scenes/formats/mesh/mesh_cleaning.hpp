#pragma once
// From the triangles of a file to triangles that a scene can hold.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/formats/mesh/mesh.hpp"

namespace beambench::scenes::mesh {

/// Vertices of a file that its triangles share by index. Remembers which vertex of the collected
/// mesh each became, so that equal places are looked for once a vertex, not once a corner.
class SharedVertices {
 public:
  explicit SharedVertices(std::vector<glm::vec3> places);

  const std::vector<glm::vec3>& places() const { return places_; }

 private:
  friend class MeshCollector;

  std::vector<glm::vec3> places_;
  std::vector<std::uint32_t> collected_;
};

/// Collects triangles as a file has them: vertices at the same place become one, unused ones go,
/// and triangles without area are left out and counted.
class MeshCollector {
 public:
  /// Makes room for as many, which spares growing. Fewer or more may come.
  void reserve(std::size_t vertices, std::size_t triangles);
  /// Triangles added from now on have this surface.
  void set_surface(const Surface& surface);
  /// Throws InputError naming the triangle when a coordinate is not a number from -1e9 to 1e9, or
  /// when there are too many for 32-bit indices.
  void add(const std::array<glm::vec3, 3>& corners);
  /// The same for corners that are indices, each in range.
  void add(SharedVertices& vertices, const std::array<std::uint32_t, 3>& corners);
  /// The same for a polygon, convex or concave: its triangles are those of `triangulate`. One
  /// without area counts as a triangle without area.
  void add_polygon(SharedVertices& vertices, std::span<const std::uint32_t> corners);

  /// How many triangles were left out, and which was the first (counted from 0 as they were added).
  std::size_t degenerate() const { return degenerate_; }
  std::size_t first_degenerate() const { return first_degenerate_; }
  TriangleMesh finish() &&;

 private:
  std::uint32_t vertex(const glm::vec3& position);
  std::size_t number() const { return mesh_.triangles.size() + degenerate_; }
  void grow(std::size_t slots);
  void leave_out();
  void push_triangle(const std::array<std::uint32_t, 3>& corners);

  TriangleMesh mesh_;
  Surface surface_;
  std::vector<std::uint32_t> slots_;  // an open hash table of indices into mesh_.vertices
  std::size_t degenerate_ = 0;
  std::size_t first_degenerate_ = 0;
};

}  // namespace beambench::scenes::mesh

#pragma once
// Converts the triangles of a file to triangles that are valid in a scene.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/formats/mesh/mesh.hpp"

namespace beambench::scenes::mesh {

/// Vertices of a file that its triangles share by index. Remembers the corresponding vertices of
/// the collected mesh, so that positions are looked up once per vertex, not once per corner.
class SharedVertices {
 public:
  /// If `merges` is false, the vertices are not merged with others at the same position, because
  /// they may separate when the mesh moves.
  explicit SharedVertices(std::vector<glm::vec3> places, bool merges = true);

  const std::vector<glm::vec3>& places() const { return places_; }
  /// Returns the vertex of the collected mesh; nothing if no triangle uses it.
  std::optional<std::uint32_t> collected(std::size_t index) const;

 private:
  friend class MeshCollector;

  std::vector<glm::vec3> places_;
  std::vector<std::uint32_t> collected_;
  bool merges_;
};

/// Collects triangles from a file: vertices at the same position are merged, unused vertices are
/// dropped, and triangles without area are left out and counted.
class MeshCollector {
 public:
  /// Reserves memory. Fewer or more triangles may follow.
  void reserve(std::size_t vertices, std::size_t triangles);
  /// Sets the surface of triangles added from now on.
  void set_surface(const Surface& surface);
  /// Throws InputError with the triangle's number if a coordinate is not a number from -1e9 to 1e9,
  /// or if there are too many triangles for 32-bit indices.
  void add(const std::array<glm::vec3, 3>& corners);
  /// Adds a triangle whose corners are indices, each in range.
  void add(SharedVertices& vertices, const std::array<std::uint32_t, 3>& corners);
  /// Adds a polygon, convex or concave, as the triangles of `triangulate`. A polygon without area
  /// counts as a triangle without area.
  void add_polygon(SharedVertices& vertices, std::span<const std::uint32_t> corners);

  /// Return the number of triangles left out, and the index of the first (in the order added, from
  /// 0).
  std::size_t degenerate() const { return degenerate_; }
  std::size_t first_degenerate() const { return first_degenerate_; }
  TriangleMesh finish() &&;

 private:
  std::uint32_t vertex(const glm::vec3& position);
  std::uint32_t push_vertex(const glm::vec3& position);
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

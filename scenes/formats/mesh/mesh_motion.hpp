#pragma once
// The motion of a mesh's vertices from frame to frame.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace beambench::scenes::mesh {

/// The weight of one matrix in a vertex.
struct Influence {
  std::uint32_t matrix;
  double weight;
};

/// A moving vertex: the weighted sum of its rest position transformed by its matrices.
struct MovingVertex {
  glm::dvec3 rest{0.0};
  std::uint32_t first = 0;  ///< index of its first influence
  std::uint32_t count = 0;  ///< 0: the vertex is static
};

/// The frames of a mesh. Frame 0 is the mesh itself.
struct MeshMotion {
  std::uint32_t frames = 1;            ///< 1: the mesh does not move, and all lists are empty
  std::vector<MovingVertex> vertices;  ///< one for each vertex of the mesh
  std::vector<Influence> influences;
  std::vector<glm::dmat4> matrices;  ///< frame by frame, the same number for each

  bool moves() const { return frames > 1; }
};

/// Returns the weighted sum of a vertex, rounded once, without negative zeros.
glm::vec3 moved(const glm::dvec3& rest, std::span<const Influence> influences,
                std::span<const glm::dmat4> matrices);

/// Returns the vertices of a mesh in a frame, given those of frame 0.
std::vector<glm::vec3> vertices_in(const MeshMotion& motion, std::uint32_t frame,
                                   std::span<const glm::vec3> vertices);

/// Returns whether all indices are in range, for a mesh of that many vertices.
bool is_consistent(const MeshMotion& motion, std::size_t vertices);

}  // namespace beambench::scenes::mesh

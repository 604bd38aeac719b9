#include "scenes/formats/mesh/mesh_motion.hpp"

#include <algorithm>

#include <glm/vec4.hpp>

namespace beambench::scenes::mesh {

glm::vec3 moved(const glm::dvec3& rest, std::span<const Influence> influences,
                std::span<const glm::dmat4> matrices) {
  glm::dvec3 sum(0.0);
  for (const Influence& influence : influences) {
    sum += influence.weight * glm::dvec3(matrices[influence.matrix] * glm::dvec4(rest, 1.0));
  }
  return glm::vec3(sum) + 0.0F;
}

std::vector<glm::vec3> vertices_in(const MeshMotion& motion, std::uint32_t frame,
                                   std::span<const glm::vec3> vertices) {
  std::vector<glm::vec3> places(vertices.begin(), vertices.end());
  const std::size_t count = motion.matrices.size() / motion.frames;
  const auto matrices = std::span(motion.matrices).subspan(frame * count, count);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const MovingVertex& vertex = motion.vertices[i];
    if (vertex.count == 0) continue;
    places[i] = moved(vertex.rest, std::span(motion.influences).subspan(vertex.first, vertex.count),
                      matrices);
  }
  return places;
}

bool is_consistent(const MeshMotion& motion, std::size_t vertices) {
  if (!motion.moves()) return motion.frames == 1;
  const std::size_t matrices = motion.matrices.size() / motion.frames;
  return motion.matrices.size() % motion.frames == 0 && motion.vertices.size() == vertices &&
         std::ranges::all_of(
             motion.influences,
             [&](const Influence& influence) { return influence.matrix < matrices; }) &&
         std::ranges::all_of(motion.vertices, [&](const MovingVertex& vertex) {
           const std::size_t size = motion.influences.size();
           return vertex.count <= size && vertex.first <= size - vertex.count;
         });
}

}  // namespace beambench::scenes::mesh

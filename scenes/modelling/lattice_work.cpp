#include "scenes/modelling/lattice_work.hpp"

#include <array>

#include <glm/geometric.hpp>

#include "scenes/modelling/sweep.hpp"

namespace beambench::scenes::modelling {

PolygonMesh bar(const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& outward,
                double thickness) {
  const std::array<glm::dvec2, 4> square = {{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
  const std::array<glm::dvec3, 2> path = {from, to};
  const std::array<double, 2> scales = {thickness, thickness};
  return sweep(square, path, scales, outward, Caps::kNone);
}

PolygonMesh braced_face(std::span<const glm::dvec3> left, std::span<const glm::dvec3> right,
                        const glm::dvec3& outward, const Bracing& bracing) {
  PolygonMesh mesh;
  for (std::size_t i = 0; i < left.size(); ++i) {
    append(mesh, bar(left[i], right[i], outward, bracing.crossbar));
    if (i + 1 == left.size()) break;
    append(mesh, bar(left[i], right[i + 1], outward, bracing.diagonal));
    append(mesh, bar(right[i], left[i + 1], outward, 0.85 * bracing.diagonal));
  }
  return mesh;
}

}  // namespace beambench::scenes::modelling

#include "scenes/generators/thesis/plant.hpp"

#include <cmath>

#include "scenes/base/portable_math.hpp"

namespace beambench::scenes::generators {
namespace {

/// Returns the width of a leaf, relative to its full width, at the share `s` of its length.
double outline(double s) { return std::sqrt(s + 0.06) * (1.0 - s * s) * 1.32; }

}  // namespace

modelling::PolygonMesh arching_leaf(const ArchingLeaf& leaf, int pieces) {
  constexpr double kFold = 0.30;  // height of the edges above the midrib
  const glm::dvec3 out(portable_cos(leaf.azimuth), portable_sin(leaf.azimuth), 0.0);
  const glm::dvec3 across(-out.y, out.x, 0.0);
  modelling::PolygonMesh mesh;
  glm::dvec3 place = leaf.root;
  for (int i = 0; i <= pieces; ++i) {
    const double s = static_cast<double>(i) / pieces;
    const double angle = leaf.rise - (leaf.rise + leaf.fall) * s;
    const glm::dvec3 forward =
        portable_cos(angle) * out + glm::dvec3(0.0, 0.0, portable_sin(angle));
    const glm::dvec3 upward =
        -portable_sin(angle) * out + glm::dvec3(0.0, 0.0, portable_cos(angle));
    const double half = 0.5 * leaf.width * outline(s);
    if (i == pieces) {
      mesh.vertices.push_back(place);
    } else {
      mesh.vertices.push_back(place + half * (across + kFold * upward));
      mesh.vertices.push_back(place);
      mesh.vertices.push_back(place - half * (across - kFold * upward));
    }
    place += forward * (leaf.length / pieces);
  }
  for (std::uint32_t i = 0; i + 1 < static_cast<std::uint32_t>(pieces); ++i) {
    const std::uint32_t at = 3 * i;
    mesh.polygons.push_back({at, at + 1, at + 4, at + 3});
    mesh.polygons.push_back({at + 1, at + 2, at + 5, at + 4});
  }
  const auto tip = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  mesh.polygons.push_back({tip - 3, tip - 2, tip});
  mesh.polygons.push_back({tip - 2, tip - 1, tip});
  return mesh;
}

}  // namespace beambench::scenes::generators

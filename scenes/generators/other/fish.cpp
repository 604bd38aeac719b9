#include "scenes/generators/other/fish.hpp"

#include <numbers>
#include <utility>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/vec2.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/modelling/extrusion.hpp"
#include "scenes/modelling/implicit_surface.hpp"
#include "scenes/modelling/lathe.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/subdivide.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kTailRoot = -0.30;  // the x where the body ends
constexpr double kFlatness = 0.48;   // width of the body divided by its height

/// Returns the body, revolved about z and then laid along x and flattened.
modelling::PolygonMesh body(int detail) {
  const int pieces = 2 * detail;
  std::vector<glm::dvec2> profile;
  for (int i = 0; i <= pieces; ++i) {
    const double s = static_cast<double>(i) / pieces;
    const bool is_end = i == 0 || i == pieces;
    const double radius = portable_sin(std::numbers::pi * s) * (0.13 + 0.13 * s);
    profile.emplace_back(is_end ? 0.0 : radius, glm::mix(kTailRoot, 0.5, s));
  }
  modelling::PolygonMesh mesh = modelling::lathe(profile, 2 * detail + 2);
  for (glm::dvec3& vertex : mesh.vertices) {
    vertex = {vertex.z, kFlatness * vertex.y, -vertex.x};
  }
  return mesh;
}

/// Returns a flat fin in the plane of symmetry, with an outline of points (x, z).
modelling::PolygonMesh fin(std::vector<glm::dvec2> outline) {
  constexpr double kThickness = 0.016;
  return modelling::transformed(
      modelling::extruded(modelling::flat_polygon(std::move(outline)), kThickness),
      modelling::rotation(0, 90.0) *
          glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, -0.5 * kThickness)));
}

modelling::PolygonMesh eye(double side) {
  return modelling::transformed(
      modelling::ellipsoid(glm::dvec3(0.022), 6, 4),
      glm::translate(glm::dmat4(1.0), glm::dvec3(0.37, side * 0.062, 0.035)));
}

void add(Fish& fish, const modelling::PolygonMesh& mesh, FishPart part) {
  const modelling::PolygonMesh triangles = modelling::triangulated(mesh);
  modelling::append(fish.mesh, triangles);
  fish.part.resize(fish.mesh.size(), part);
}

}  // namespace

Fish fish(int detail) {
  Fish result;
  add(result, body(detail), FishPart::kBody);
  for (std::size_t i = 0; i < result.mesh.size(); ++i) {
    const double x = modelling::middle(result.mesh, i).x;
    const bool is_stripe = (x > 0.20 && x < 0.29) || (x > -0.03 && x < 0.06) || x < -0.20;
    if (is_stripe) result.part[i] = FishPart::kStripe;
  }
  add(result, fin({{-0.27, -0.03}, {-0.50, -0.17}, {-0.43, 0.0}, {-0.50, 0.17}, {-0.27, 0.03}}),
      FishPart::kFin);
  add(result, fin({{-0.10, 0.10}, {0.26, 0.13}, {0.10, 0.26}, {-0.14, 0.22}}), FishPart::kFin);
  add(result, fin({{0.04, -0.27}, {0.22, -0.14}, {0.02, -0.10}, {-0.08, -0.22}}), FishPart::kFin);
  for (const double side : {-1.0, 1.0}) add(result, eye(side), FishPart::kEye);
  return result;
}

}  // namespace beambench::scenes::generators

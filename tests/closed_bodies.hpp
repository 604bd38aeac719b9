#pragma once
// Closed meshes, and placements of them in scenes.

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "harness/verify/selftest/test_scenes.hpp"
#include "scenes/base/portable_math.hpp"
#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/modelling/box.hpp"
#include "scenes/modelling/parametric_surface.hpp"
#include "scenes/modelling/subdivide.hpp"

namespace beambench::tests {

/// A closed mesh of triangles about the origin.
struct Body {
  std::string name;
  scenes::modelling::PolygonMesh mesh;
  double clearance;  ///< balls of this radius about `middles` are inside
  std::vector<glm::dvec3> middles{glm::dvec3(0.0)};
  double reach = 0.0;  ///< of the farthest vertex
};

inline scenes::modelling::PolygonMesh tetrahedron() {
  return {{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
          {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

inline scenes::modelling::PolygonMesh bumpy(const char* name) {
  const scenes::Scene scene = scenes::load_scene(name);
  scenes::modelling::PolygonMesh mesh;
  for (const glm::vec3& vertex : scene.vertices) mesh.vertices.emplace_back(vertex);
  for (const scenes::Triangle& triangle : scene.triangles) {
    mesh.polygons.emplace_back(triangle.vertex.begin(), triangle.vertex.end());
  }
  return mesh;
}

inline constexpr int kTorusSlices = 24;

/// Returns a point on a torus about z with major radius 1 and minor radius `thickness`.
inline glm::dvec3 torus_point(double u, double v, double thickness) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double radius = 1.0 + thickness * portable_cos(kTurn * v);
  return {radius * portable_cos(kTurn * u), radius * portable_sin(kTurn * u),
          thickness * portable_sin(kTurn * v)};
}

inline std::vector<Body> bodies() {
  std::vector<Body> all{
      {"tetrahedron", tetrahedron(), 0.4},
      {"box", scenes::modelling::box(glm::dvec3(-1.0), glm::dvec3(1.0)), 0.9},
      {"divided box",
       scenes::modelling::subdivided_to(scenes::modelling::box(glm::dvec3(-1.0), glm::dvec3(1.0)),
                                        96),
       0.9},
      {"flat box", scenes::modelling::box({-1.0, -0.7, -0.01}, {1.0, 0.7, 0.01}), 0.005},
      {"ball", scenes::modelling::ellipsoid(glm::dvec3(1.0), 16, 10), 0.8},
      {"needle", scenes::modelling::ellipsoid({0.03, 0.03, 1.0}, 12, 8), 0.02},
      {"bumpy, coarse", bumpy("bumpy:triangles=48"), 0.3},
      {"bumpy", bumpy("bumpy:triangles=300"), 0.3}};
  Body torus{"torus",
             scenes::modelling::parametric_surface(
                 [](double u, double v) { return torus_point(u, v, 0.4); }, kTorusSlices, 10),
             0.25,
             {}};
  for (int i = 0; i < kTorusSlices; ++i) {
    torus.middles.push_back(torus_point((i + 0.5) / kTorusSlices, 0.0, 0.0));
  }
  all.push_back(std::move(torus));
  for (Body& body : all) {
    body.mesh = scenes::modelling::triangulated(body.mesh);
    for (const glm::dvec3& vertex : body.mesh.vertices) {
      body.reach = std::max(body.reach, glm::length(vertex));
    }
  }
  return all;
}

inline glm::dvec3 direction_from(Random& random) {
  return glm::normalize(verify::point_in_cube(random));
}

/// A random rotation, scale and shift; sometimes the identity, so that faces are axis-aligned.
struct Placement {
  explicit Placement(Random& random) {
    if (random.below(4) == 0) return;
    turn = glm::normalize(glm::dquat(random.uniform(-1.0, 1.0), verify::point_in_cube(random)));
    scale = portable_exp(random.uniform(-5.0, 5.0));
    shift = scale * 5.0 * verify::point_in_cube(random);
  }
  glm::dvec3 operator()(const glm::dvec3& point) const { return shift + scale * (turn * point); }

  glm::dquat turn = glm::identity<glm::dquat>();
  double scale = 1.0;
  glm::dvec3 shift{0.0};
};

}  // namespace beambench::tests

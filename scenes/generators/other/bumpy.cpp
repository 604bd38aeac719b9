#include "scenes/generators/other/bumpy.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

/// The points of a cube's surface on a grid of k cells per edge, numbered layer by layer: a full
/// square at the bottom, rings of 4 k points, and a full square at the top.
class CubeGrid {
 public:
  explicit CubeGrid(std::uint32_t k) : k_(k) {}

  std::uint32_t point(const std::array<std::uint32_t, 3>& at) const {
    const auto [x, y, z] = at;
    const std::uint32_t square = (k_ + 1) * (k_ + 1);
    if (z == 0) return y * (k_ + 1) + x;
    if (z == k_) return square + (k_ - 1) * 4 * k_ + y * (k_ + 1) + x;
    return square + (z - 1) * 4 * k_ + ring(x, y);
  }

  /// Calls visit(x, y, z) for all points in the order of their numbers.
  template <typename Visit>
  void for_each_point(Visit visit) const {
    for (std::uint32_t z = 0; z <= k_; ++z) {
      if (z == 0 || z == k_) {
        for (std::uint32_t i = 0; i < (k_ + 1) * (k_ + 1); ++i)
          visit(i % (k_ + 1), i / (k_ + 1), z);
        continue;
      }
      for (std::uint32_t i = 0; i < k_; ++i) visit(i, 0U, z);
      for (std::uint32_t i = 0; i < k_; ++i) visit(k_, i, z);
      for (std::uint32_t i = 0; i < k_; ++i) visit(k_ - i, k_, z);
      for (std::uint32_t i = 0; i < k_; ++i) visit(0U, k_ - i, z);
    }
  }

 private:
  /// Returns a point's number on the square's border, counted counter-clockwise from (0, 0).
  std::uint32_t ring(std::uint32_t x, std::uint32_t y) const {
    if (y == 0 && x < k_) return x;
    if (x == k_ && y < k_) return k_ + y;
    if (y == k_ && x > 0) return 3 * k_ - x;
    return 4 * k_ - y;
  }

  std::uint32_t k_;
};

/// Returns a smooth wave of period 1 between -1 and 1, made of polynomials because sines differ
/// between machines.
double wave(double x) {
  const double t = x - std::floor(x);
  const double u = t < 0.5 ? t : t - 0.5;
  const double arch = 16.0 * u * (0.5 - u);
  return t < 0.5 ? arch : -arch;
}

/// Returns the point of the bumpy sphere over a point c on the surface of the cube [-1, 1]^3.
glm::dvec3 bumpy_point(const glm::dvec3& c) {
  const glm::dvec3 s = c * c;
  // Spreads the grid more evenly over the unit sphere than normalizing would.
  const glm::dvec3 on_sphere(c.x * std::sqrt(1.0 - s.y / 2.0 - s.z / 2.0 + s.y * s.z / 3.0),
                             c.y * std::sqrt(1.0 - s.z / 2.0 - s.x / 2.0 + s.z * s.x / 3.0),
                             c.z * std::sqrt(1.0 - s.x / 2.0 - s.y / 2.0 + s.x * s.y / 3.0));
  const glm::dvec3 p = on_sphere;
  const double large = wave(1.5 * p.x + 0.1) * wave(1.5 * p.y + 0.2) * wave(1.5 * p.z + 0.3);
  const double small = wave(5.0 * p.x) + wave(5.0 * p.y) + wave(5.0 * p.z);
  return on_sphere * (1.0 + 0.22 * large + 0.02 * small);
}

std::uint32_t cells_per_edge(std::int64_t triangles) {
  const double k = std::sqrt(static_cast<double>(triangles) / 12.0);
  const auto below = static_cast<std::int64_t>(k);
  const std::int64_t short_by = triangles - 12 * below * below;
  const std::int64_t over_by = 12 * (below + 1) * (below + 1) - triangles;
  return static_cast<std::uint32_t>(
      std::max<std::int64_t>(1, below + (over_by < short_by ? 1 : 0)));
}

/// Adds the two sides of the cube across one axis, with two triangles per cell, counter-clockwise
/// as seen from outside.
void add_sides(BumpyMesh& mesh, const CubeGrid& grid, std::uint32_t k, std::size_t axis) {
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  const auto corner = [&](std::uint32_t i, std::uint32_t j, std::uint32_t level) {
    std::array<std::uint32_t, 3> at{};
    at[u] = i;
    at[v] = j;
    at[axis] = level;
    return grid.point(at);
  };
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, bool flip) {
    mesh.triangles.push_back({a, flip ? c : b, flip ? b : c});
  };
  for (const std::uint32_t level : {0U, k}) {
    for (std::uint32_t j = 0; j < k; ++j) {
      for (std::uint32_t i = 0; i < k; ++i) {
        const std::uint32_t a = corner(i, j, level);
        const std::uint32_t c = corner(i + 1, j + 1, level);
        add(a, corner(i + 1, j, level), c, level == 0);
        add(a, c, corner(i, j + 1, level), level == 0);
      }
    }
  }
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  Camera camera;
  camera.from = {2.6F, 1.6F, 1.5F};
  camera.at = {0.0F, 0.0F, 0.0F};
  camera.up = {0.0F, 0.0F, 1.0F};
  builder.add_camera(camera);
  builder.set_background({0.078, 0.361, 0.753});
  builder.add_light({5.0, 1.0, 4.0});
  builder.add_light({1.0, 6.0, 2.0});

  const BumpyMesh mesh = bumpy_mesh(parameters.integer("triangles"));
  for (const glm::dvec3& vertex : mesh.vertices) builder.add_vertex(vertex);
  builder.set_surface(
      {.color = {0.85F, 0.55F, 0.35F}, .diffuse = 0.8F, .specular = 0.2F, .shine = 30.0F});
  for (const auto& corners : mesh.triangles) builder.add_polygon(corners);
  return std::move(builder).build();
}

}  // namespace

BumpyMesh bumpy_mesh(std::int64_t triangles) {
  const std::uint32_t k = cells_per_edge(triangles);
  const CubeGrid grid(k);
  BumpyMesh mesh;
  grid.for_each_point([&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    mesh.vertices.push_back(bumpy_point(glm::dvec3(x, y, z) * (2.0 / k) - 1.0));
  });
  for (std::size_t axis = 0; axis < 3; ++axis) add_sides(mesh, grid, k, axis);
  return mesh;
}

void register_bumpy(Catalogue& catalogue) {
  catalogue.add({"bumpy",
                 "A closed bumpy sphere of 12 k^2 triangles (15,552 by default)",
                 {integer_parameter("triangles", 15680, 12, 20000000,
                                    "number of triangles, rounded to 12 k^2 for the nearest k")},
                 generate,
                 "triangles"});
}

}  // namespace beambench::scenes::generators

#include "scenes/generators/spd/teapot.hpp"

#include <array>
#include <vector>

#include <glm/geometric.hpp>

#include "scenes/catalogue.hpp"
#include "scenes/generators/spd/spd_sky.hpp"
#include "scenes/generators/thesis/teapot_patches.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

/// A point of a patch's grid, in the builder.
struct GridPoint {
  std::uint32_t vertex;
  glm::dvec3 normal;
  bool pole;
};

class PatchMesh {
 public:
  PatchMesh(SceneBuilder& builder, const BezierPatch& patch, std::int64_t n)
      : builder_(builder), n_(n) {
    for (std::int64_t i = 0; i <= n; ++i) {
      for (std::int64_t j = 0; j <= n; ++j) points_.push_back(evaluate(patch, i, j));
    }
  }

  /// Two triangles for each cell; at a pole, where a side of the cell is a point, one.
  void add_triangles() const {
    for (std::int64_t i = 0; i < n_; ++i) {
      for (std::int64_t j = 0; j < n_; ++j) {
        add_triangle(point(i, j), point(i, j + 1), point(i + 1, j + 1));
        add_triangle(point(i + 1, j + 1), point(i + 1, j), point(i, j));
      }
    }
  }

 private:
  GridPoint evaluate(const BezierPatch& patch, std::int64_t i, std::int64_t j) {
    const auto n = static_cast<double>(n_);
    const PatchPoint at =
        evaluate_patch(patch, static_cast<double>(i) / n, static_cast<double>(j) / n);
    // Only the lid's tip and the middle of the bottom lie on the axis; there the patch's first row
    // is one point and has no normal of its own.
    const bool pole = at.position.x == 0.0 && at.position.y == 0.0;
    if (pole && j > 0) return point(i, 0);
    const glm::dvec3 normal =
        pole ? glm::dvec3(0.0, 0.0, at.position.z > 1.5 ? 1.0 : -1.0) : glm::normalize(at.normal);
    return {builder_.add_vertex(at.position), normal, pole};
  }

  const GridPoint& point(std::int64_t i, std::int64_t j) const {
    return points_[static_cast<std::size_t>(i * (n_ + 1) + j)];
  }

  void add_triangle(const GridPoint& a, const GridPoint& b, const GridPoint& c) const {
    if (int{a.pole} + int{b.pole} + int{c.pole} > 1) return;
    builder_.add_polygon(std::array{a.vertex, b.vertex, c.vertex},
                         std::array{a.normal, b.normal, c.normal});
  }

  SceneBuilder& builder_;
  std::int64_t n_;
  std::vector<GridPoint> points_;
};

/// The squares of one color of a chessboard of n x n over [-4, 4]^2.
void add_squares(SceneBuilder& builder, std::int64_t n, std::int64_t color) {
  const auto place = [n](std::int64_t i) {
    return 4.0 * (2.0 * static_cast<double>(i) / static_cast<double>(n) - 1.0);
  };
  for (std::int64_t i = 0; i < n; ++i) {
    for (std::int64_t j = 0; j < n; ++j) {
      if ((i + j) % 2 != color) continue;
      builder.add_polygon(std::array<glm::dvec3, 4>{{{place(i), place(j), 0.0},
                                                     {place(i + 1), place(j), 0.0},
                                                     {place(i + 1), place(j + 1), 0.0},
                                                     {place(i), place(j + 1), 0.0}}});
    }
  }
}

Scene generate(const Parameters& parameters) {
  const std::int64_t n = parameters.integer("n");
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {4.86F, 7.2F, 5.4F},
                      .at = {0.0F, 0.0F, 0.0F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .hither = 1.0F});
  builder.set_background(kSpdSky);
  builder.add_light({-3.1, 9.8, 12.1});
  builder.add_light({11.3, 5.1, 8.8});

  const Surface white = {.diffuse = 0.5F, .specular = 0.5F, .shine = 4.81884F};
  builder.set_surface(white);
  add_squares(builder, n, 1);
  Surface gray = white;
  gray.color = glm::vec3(0.5F);
  builder.set_surface(gray);
  add_squares(builder, n, 0);
  builder.set_surface(
      {.color = {1.0F, 0.5F, 0.1F}, .diffuse = 0.75F, .specular = 0.25F, .shine = 3.0827F});
  add_teapot(builder, n);
  return std::move(builder).build();
}

}  // namespace

void add_teapot(SceneBuilder& builder, std::int64_t n) {
  for (const BezierPatch& patch : teapot_patches()) {
    PatchMesh(builder, patch, n).add_triangles();
  }
}

void register_teapot(Catalogue& catalogue) {
  catalogue.add(
      {"teapot",
       "Newell's teapot of 64 n^2 - 8 n smooth triangles on a board of n^2 squares (Haines's "
       "SPD)",
       {integer_parameter("n", 12, 2, 400, "quads along each side of a patch")},
       generate,
       "n"});
}

}  // namespace beambench::scenes::generators

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/generators/moving/motion.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kHeight = 3.2;

/// A point of the body with its normal. The body is a column of four ribs that bulges near the
/// bottom and tapers to a point at both ends.
struct Point {
  glm::dvec3 place;
  glm::dvec3 normal;
};

double radius_at(double around, double up) {
  const double profile = std::sqrt(up * (1.0 - up)) * (2.1 - 1.0 * up);
  return profile * (1.0 + 0.16 * portable_cos(4.0 * kFullTurn * around));
}

glm::dvec3 straight_place(double around, double up) {
  const double radius = radius_at(around, up);
  return {radius * portable_cos(kFullTurn * around), radius * portable_sin(kFullTurn * around),
          kHeight * up};
}

Point straight_point(double around, double up) {
  // Differences suffice instead of derivatives, because the normals only affect shading.
  constexpr double kStep = 1e-4;
  const double low = std::fmax(up - kStep, 1e-9);
  const double high = std::fmin(up + kStep, 1.0 - 1e-9);
  const glm::dvec3 sideways =
      straight_place(around + kStep, up) - straight_place(around - kStep, up);
  const glm::dvec3 upward = straight_place(around, high) - straight_place(around, low);
  return {straight_place(around, up), glm::normalize(glm::cross(sideways, upward))};
}

/// Returns the point after a twist of `turns` full turns from the bottom to the top. The normal is
/// transformed by the inverse transpose of the twist's derivative.
Point twisted(const Point& point, double turns) {
  const auto& [p, n] = point;
  const double rate = kFullTurn * turns / kHeight;
  const double sine = portable_sin(rate * p.z);
  const double cosine = portable_cos(rate * p.z);
  const glm::dvec3 normal(cosine * n.x - sine * n.y, sine * n.x + cosine * n.y,
                          n.z - rate * (n.y * p.x - n.x * p.y));
  return {{cosine * p.x - sine * p.y, sine * p.x + cosine * p.y, p.z}, glm::normalize(normal)};
}

/// The grid of the body: `around` columns, and `up` steps from the bottom tip to the top tip.
struct Grid {
  std::uint32_t around;
  std::uint32_t up;

  std::size_t size() const { return std::size_t{around} * (up - 1) + 2; }
  /// Returns the vertex in a column and a row; rows 0 and `up` are the tips.
  std::uint32_t vertex(std::uint32_t column, std::uint32_t row) const {
    if (row == 0) return 0;
    if (row == up) return around * (up - 1) + 1;
    return 1 + (row - 1) * around + column % around;
  }
  Point point(std::size_t vertex) const {
    if (vertex == 0) return {{0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}};
    if (vertex + 1 == size()) return {{0.0, 0.0, kHeight}, {0.0, 0.0, 1.0}};
    const auto row = (vertex - 1) / around + 1;
    // Rows lie closer together at the tips, where the body curves most.
    const double share = static_cast<double>(row) / up;
    return straight_point(static_cast<double>((vertex - 1) % around) / around,
                          share * share * (3.0 - 2.0 * share));
  }
};

/// Calls `add` with the corners of each triangle and its column.
template <typename Add>
void for_each_triangle(const Grid& grid, Add add) {
  for (std::uint32_t row = 0; row < grid.up; ++row) {
    for (std::uint32_t column = 0; column < grid.around; ++column) {
      const std::uint32_t a = grid.vertex(column, row);
      const std::uint32_t b = grid.vertex(column + 1, row);
      const std::uint32_t c = grid.vertex(column + 1, row + 1);
      const std::uint32_t d = grid.vertex(column, row + 1);
      if (row > 0) add(std::array{a, b, c}, column);
      if (row + 1 < grid.up) add(std::array{a, c, d}, column);
    }
  }
}

/// Returns the surface of a column: each rib has two pairs of a light and a dark stripe.
Surface stripe(std::uint32_t column, std::uint32_t around) {
  const bool light = (8 * column / around) % 2 == 0;
  return {.color = light ? glm::vec3(0.92F, 0.88F, 0.78F) : glm::vec3(0.16F, 0.42F, 0.44F),
          .diffuse = 0.8F,
          .specular = 0.2F,
          .shine = 30.0F};
}

Animation animate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  add_wide_camera(builder, "default", {3.0, -4.7, 3.1}, {0.0, 0.0, 1.5}, 42.0F);
  add_wide_camera(builder, "above", {0.6, -2.6, 6.2}, {0.0, 0.0, 1.2}, 40.0F);
  light_motion(builder, 3.0);

  const std::uint32_t cells = cells_for(parameters.integer("triangles"));
  const Grid grid{8 * std::max(1U, (cells + 4) / 8), std::max(2U, cells)};
  const std::uint32_t frames = frames_of(parameters);
  const double turns = parameters.real("turns");
  builder.reserve_triangles(grid.size(), 2 * std::size_t{grid.around} * grid.up);
  std::vector<Point> straight;
  straight.reserve(grid.size());
  for (std::size_t i = 0; i < grid.size(); ++i) {
    straight.push_back(grid.point(i));
    builder.add_vertex(twisted(straight.back(), 0.0).place);
  }
  const auto normal = [&](std::uint32_t vertex) { return twisted(straight[vertex], 0.0).normal; };
  for_each_triangle(grid, [&](const std::array<std::uint32_t, 3>& corners, std::uint32_t column) {
    builder.set_surface(stripe(column, grid.around));
    builder.add_polygon(corners,
                        std::array{normal(corners[0]), normal(corners[1]), normal(corners[2])});
  });
  add_floor(builder, 14.0, -0.02);
  Scene scene = std::move(builder).build();
  Pose still = pose_of(scene);
  auto pose = [still = std::move(still), straight = std::move(straight), grid, frames,
               turns](std::uint32_t frame) {
    Pose moved = still;
    const double twist = turns * frame / (frames - 1);
    std::vector<glm::vec3> normals;
    for (std::size_t i = 0; i < straight.size(); ++i) {
      const Point point = twisted(straight[i], twist);
      moved.vertices[i] = glm::vec3(point.place) + 0.0F;  // rounds as the builder does
      normals.push_back(glm::vec3(point.normal) + 0.0F);
    }
    auto next = moved.normals.begin();
    for_each_triangle(grid, [&](const std::array<std::uint32_t, 3>& corners, std::uint32_t) {
      for (const std::uint32_t corner : corners) *next++ = normals[corner];
    });
    return moved;
  };
  return {std::move(scene), frames, std::move(pose)};
}

}  // namespace

void register_twisting_body(Catalogue& catalogue) {
  catalogue.add({.name = "twisting-body",
                 .summary =
                     "A ribbed body of smooth triangles (about 20,000 by default) on a floor, "
                     "twisted more with each frame",
                 .parameters = {integer_parameter("triangles", 20000, 32, 20000000,
                                                  "number of triangles of the body, approximately"),
                                real_parameter("turns", 1.0, -10.0, 10.0,
                                               "full turns of the body's top in the last frame"),
                                frames_parameter()},
                 .size_parameter = "triangles",
                 .animate = animate});
}

}  // namespace beambench::scenes::generators

#include "scenes/generators/thesis/escena1.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include <glm/geometric.hpp>

#include "scenes/base/random.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kHalfSize = 10.0;  // the spheres fill the cube [-10, 10]^3

/// The balls, listed by the grid cells of their centers, so that millions of balls can be placed.
class BallGrid {
 public:
  /// `cells`: the number of cells along each axis.
  explicit BallGrid(std::int64_t cells)
      : cells_(cells),
        width_(2.0 * kHalfSize / static_cast<double>(cells)),
        first_(static_cast<std::size_t>(cells * cells * cells), kNone) {}

  void add(const Ball& ball) {
    std::uint32_t& first = first_[index(cell(ball.center))];
    next_.push_back(first);
    first = static_cast<std::uint32_t>(balls_.size());
    balls_.push_back(ball);
    largest_ = std::max(largest_, ball.radius);
  }

  /// Returns the free room around a point: its distance from the nearest ball, at most the cube's
  /// edge. If this distance is at most `wanted`, any number up to `wanted` may be returned.
  /// Searches the cells shell by shell, skipping cells too far away to contain a nearer ball.
  double gap(const glm::dvec3& point, double wanted) const {
    const Cell middle = cell(point);
    double least = 2.0 * kHalfSize;
    for (std::int64_t ring = 0; ring < cells_ && least > wanted; ++ring) {
      if (static_cast<double>(ring - 1) * width_ - largest_ > least) break;
      search_shell(point, middle, ring, wanted, least);
    }
    return least;
  }

  const std::vector<Ball>& balls() const { return balls_; }

 private:
  using Cell = std::array<std::int64_t, 3>;
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  Cell cell(const glm::dvec3& point) const {
    Cell at{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double place = (point[static_cast<int>(axis)] + kHalfSize) / width_;
      at[axis] = std::clamp<std::int64_t>(static_cast<std::int64_t>(place), 0, cells_ - 1);
    }
    return at;
  }

  std::size_t index(const Cell& at) const {
    return static_cast<std::size_t>((at[2] * cells_ + at[1]) * cells_ + at[0]);
  }

  /// Returns whether the layer of cells is in the grid and close enough to contain a ball nearer
  /// than `least`, with a slight tolerance for rounding.
  bool may_hold_nearer(double coordinate, std::int64_t layer, double least) const {
    if (layer < 0 || layer >= cells_) return false;
    const double low = static_cast<double>(layer) * width_ - kHalfSize;
    const double away = std::max(low - coordinate, coordinate - (low + width_));
    return away - largest_ <= least + 1e-9;
  }

  void search_shell(const glm::dvec3& point, const Cell& middle, std::int64_t ring, double wanted,
                    double& least) const {
    for (std::int64_t z = middle[2] - ring; z <= middle[2] + ring; ++z) {
      if (!may_hold_nearer(point.z, z, least)) continue;
      for (std::int64_t y = middle[1] - ring; y <= middle[1] + ring; ++y) {
        if (!may_hold_nearer(point.y, y, least)) continue;
        if (least <= wanted) return;
        const bool face = std::abs(z - middle[2]) == ring || std::abs(y - middle[1]) == ring;
        const std::int64_t step = face || ring == 0 ? 1 : 2 * ring;
        for (std::int64_t x = middle[0] - ring; x <= middle[0] + ring; x += step) {
          if (may_hold_nearer(point.x, x, least)) search_cell(point, {x, y, z}, least);
        }
      }
    }
  }

  void search_cell(const glm::dvec3& point, const Cell& at, double& least) const {
    for (std::uint32_t i = first_[index(at)]; i != kNone; i = next_[i]) {
      least = std::min(least, glm::length(point - balls_[i].center) - balls_[i].radius);
    }
  }

  std::int64_t cells_;
  double width_;
  double largest_ = 0.0;
  std::vector<std::uint32_t> first_;  ///< first ball of each cell
  std::vector<std::uint32_t> next_;   ///< next ball in the same cell, for each ball
  std::vector<Ball> balls_;
};

constexpr std::array<glm::vec3, 6> kColors = {{{0.90F, 0.30F, 0.24F},
                                               {0.95F, 0.65F, 0.20F},
                                               {0.96F, 0.87F, 0.50F},
                                               {0.35F, 0.70F, 0.45F},
                                               {0.25F, 0.55F, 0.80F},
                                               {0.60F, 0.40F, 0.70F}}};

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  light_balls(builder);
  const std::vector<Ball> balls = scattered_balls(
      parameters.integer("spheres"), static_cast<std::uint64_t>(parameters.integer("seed")));
  for (std::size_t i = 0; i < balls.size(); ++i) {
    builder.set_surface(surface_of_ball(i, balls.size()));
    builder.add_sphere(balls[i].center, balls[i].radius);
  }
  return std::move(builder).build();
}

}  // namespace

std::vector<Ball> scattered_balls(std::int64_t count, std::uint64_t seed) {
  Random random(seed);
  constexpr int kCandidates = 16;
  std::int64_t cells = 1;  // along each axis of a grid with at least one cell per ball
  while (cells * cells * cells < count) ++cells;
  const double spacing = 2.0 * kHalfSize / static_cast<double>(cells);
  BallGrid grid(cells);
  for (std::int64_t i = 0; i < count; ++i) {
    const double radius = spacing * random.uniform(0.15, 0.55);
    const double reach = kHalfSize - radius;
    glm::dvec3 best(0.0);
    double room = -1.0;
    for (int candidate = 0; candidate < kCandidates; ++candidate) {
      const glm::dvec3 place{random.uniform(-reach, reach), random.uniform(-reach, reach),
                             random.uniform(-reach, reach)};
      const double free = grid.gap(place, room);
      if (free > room) {
        room = free;
        best = place;
      }
    }
    grid.add({best, std::clamp(room, 0.05 * spacing, radius)});
  }
  return grid.balls();
}

void light_balls(SceneBuilder& builder) {
  Camera camera;
  camera.from = {30.0F, 19.5F, 18.5F};
  camera.at = {0.0F, 0.0F, 0.0F};
  camera.up = {0.0F, 0.0F, 1.0F};
  builder.add_camera(camera);
  builder.set_background({0.078, 0.361, 0.753});
  builder.add_light({60.0, 20.0, 50.0});
  builder.add_light({20.0, 60.0, 30.0});
  builder.add_light({10.0, -40.0, 70.0});
}

Surface surface_of_ball(std::size_t number, std::size_t count) {
  return {.color = kColors[number * kColors.size() / count],
          .diffuse = 0.7F,
          .specular = 0.3F,
          .shine = 20.0F};
}

void register_escena1(Catalogue& catalogue) {
  catalogue.add(
      {"escena1",
       "The thesis's Escena 1: spheres of different sizes at random, nearly uniform over the "
       "volume",
       {integer_parameter("seed", 1999, 0, 0xFFFFFFFF, "seed of the random numbers"),
        integer_parameter("spheres", 430, 1, 10000000, "number of spheres")},
       generate,
       "spheres"});
}

}  // namespace beambench::scenes::generators

#include "scenes/generators/escena1.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <glm/geometric.hpp>

#include "scenes/random.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench {
namespace {

constexpr double kHalfSize = 10.0;  // the spheres fill the cube [-10, 10]^3

struct Ball {
  glm::dvec3 center;
  double radius;
};

/// Free room around a point: its distance to the nearest ball.
double gap(const std::vector<Ball>& balls, const glm::dvec3& point) {
  double least = 2.0 * kHalfSize;
  for (const Ball& ball : balls) {
    least = std::min(least, glm::length(point - ball.center) - ball.radius);
  }
  return least;
}

/// Balls of random sizes, spread evenly by best-candidate sampling (Mitchell 1991): of several
/// random places each ball takes the one with most room, and shrinks where that is too little.
std::vector<Ball> scatter(std::int64_t count, Random& random) {
  constexpr int kCandidates = 16;
  std::int64_t cells = 1;  // on each axis of a grid with a cell for each ball
  while (cells * cells * cells < count) ++cells;
  const double spacing = 2.0 * kHalfSize / static_cast<double>(cells);
  std::vector<Ball> balls;
  for (std::int64_t i = 0; i < count; ++i) {
    const double radius = spacing * random.uniform(0.15, 0.55);
    const double reach = kHalfSize - radius;
    glm::dvec3 best(0.0);
    double room = -1.0;
    for (int candidate = 0; candidate < kCandidates; ++candidate) {
      const glm::dvec3 place{random.uniform(-reach, reach), random.uniform(-reach, reach),
                             random.uniform(-reach, reach)};
      const double free = gap(balls, place);
      if (free > room) {
        room = free;
        best = place;
      }
    }
    balls.push_back({best, std::clamp(room, 0.05 * spacing, radius)});
  }
  return balls;
}

constexpr std::array<glm::vec3, 6> kColors = {{{0.90F, 0.30F, 0.24F},
                                               {0.95F, 0.65F, 0.20F},
                                               {0.96F, 0.87F, 0.50F},
                                               {0.35F, 0.70F, 0.45F},
                                               {0.25F, 0.55F, 0.80F},
                                               {0.60F, 0.40F, 0.70F}}};

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  Camera camera;
  camera.from = {30.0F, 19.5F, 18.5F};
  camera.at = {0.0F, 0.0F, 0.0F};
  camera.up = {0.0F, 0.0F, 1.0F};
  builder.add_camera(camera);
  builder.set_background({0.078, 0.361, 0.753});
  builder.add_light({60.0, 20.0, 50.0});
  builder.add_light({20.0, 60.0, 30.0});
  builder.add_light({10.0, -40.0, 70.0});

  Random random(static_cast<std::uint64_t>(parameters.integer("seed")));
  const std::vector<Ball> balls = scatter(parameters.integer("spheres"), random);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    builder.set_surface({.color = kColors[i * kColors.size() / balls.size()],
                         .diffuse = 0.7F,
                         .specular = 0.3F,
                         .shine = 20.0F});
    builder.add_sphere(balls[i].center, balls[i].radius);
  }
  return std::move(builder).build();
}

}  // namespace

SceneInfo escena1_scene() {
  return {"escena1",
          "The thesis's Escena 1: spheres of different sizes at random, nearly uniform over the "
          "volume",
          {integer_parameter("seed", 1999, 0, 0xFFFFFFFF, "seed of the random numbers"),
           integer_parameter("spheres", 430, 1, 10000, "number of spheres")},
          generate};
}

}  // namespace beambench

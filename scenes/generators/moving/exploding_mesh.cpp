#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/base/random.hpp"
#include "scenes/base/rotation.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/generators/moving/motion.hpp"
#include "scenes/generators/other/bumpy.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kInside = 0.72;  // distance of a shard's inner face relative to its outer one

using Corners = std::array<std::uint32_t, 3>;

glm::dvec3 direction(Random& random) {
  const double z = random.uniform(-1.0, 1.0);
  const double angle = kFullTurn * random.unit();
  const double reach = std::sqrt(1.0 - z * z);
  return {reach * portable_cos(angle), reach * portable_sin(angle), z};
}

/// Groups the triangles by the nearest of some random directions.
std::vector<std::vector<Corners>> pieces_of(const BumpyMesh& mesh, std::size_t count,
                                            Random& random) {
  std::vector<glm::dvec3> sites;
  for (std::size_t i = 0; i < count; ++i) sites.push_back(direction(random));
  std::vector<std::vector<Corners>> pieces(count);
  for (const Corners& corners : mesh.triangles) {
    const glm::dvec3 middle =
        mesh.vertices[corners[0]] + mesh.vertices[corners[1]] + mesh.vertices[corners[2]];
    const auto nearest = std::ranges::max_element(
        sites, {}, [&](const glm::dvec3& site) { return glm::dot(site, middle); });
    pieces[static_cast<std::size_t>(nearest - sites.begin())].push_back(corners);
  }
  std::erase_if(pieces, [](const auto& piece) { return piece.empty(); });
  return pieces;
}

/// A piece of the surface made into a solid: an inner face below it, and a rim around both.
struct Shard {
  std::vector<glm::dvec3> vertices;  ///< outer vertices, then as many inner ones
  std::vector<Corners> outer;
  std::vector<Corners> broken;  ///< the inner face and the rim
};

Shard shard_of(const BumpyMesh& mesh, const std::vector<Corners>& piece) {
  Shard shard;
  std::map<std::uint32_t, std::uint32_t> number;
  for (const Corners& corners : piece) {
    Corners own{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [found, is_new] =
          number.emplace(corners[i], static_cast<std::uint32_t>(number.size()));
      if (is_new) shard.vertices.push_back(mesh.vertices[corners[i]]);
      own[i] = found->second;
    }
    shard.outer.push_back(own);
  }
  const auto inner = static_cast<std::uint32_t>(shard.vertices.size());
  for (std::uint32_t i = 0; i < inner; ++i) shard.vertices.push_back(kInside * shard.vertices[i]);
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& [a, b, c] : shard.outer) {
    shard.broken.push_back({inner + a, inner + c, inner + b});
    for (const auto& edge : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) edges.insert(edge);
  }
  for (const auto& [a, b] : edges) {
    if (edges.contains({b, a})) continue;
    shard.broken.push_back({b, a, inner + a});
    shard.broken.push_back({b, inner + a, inner + b});
  }
  return shard;
}

/// A shard's flight: fast at first, then slower, turning and falling.
struct Flight {
  glm::dvec3 center;
  glm::dvec3 velocity;
  glm::dvec3 turns;  ///< total degrees about each axis

  glm::dmat4 at(double time) const {
    const glm::dvec3 way =
        time * (1.8 - 0.8 * time) * velocity - glm::dvec3(0, 0, 0.5 * time * time);
    return moved_by(center + way) * rotation(0, time * turns.x) * rotation(1, time * turns.y) *
           rotation(2, time * turns.z) * moved_by(-center);
  }
};

Flight flight_of(const Shard& shard, Random& random) {
  glm::dvec3 center(0.0);
  for (const glm::dvec3& vertex : shard.vertices) center += vertex;
  center /= static_cast<double>(shard.vertices.size());
  const glm::dvec3 outward = glm::normalize(center + 1e-3 * direction(random));
  const double speed = random.uniform(1.0, 2.2);
  glm::dvec3 turns;
  for (int axis = 0; axis < 3; ++axis) turns[axis] = random.uniform(-260.0, 260.0);
  return {center, speed * outward, turns};
}

Animation animate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  add_wide_camera(builder, "default", {5.2, -6.8, 2.9}, {0.0, 0.0, -0.15}, 41.0F);
  add_wide_camera(builder, "near", {1.7, -2.6, 0.9}, {0.0, 0.0, 0.0}, 50.0F);
  light_motion(builder, 3.0);

  const BumpyMesh mesh = bumpy_mesh(parameters.integer("triangles"));
  Random random(static_cast<std::uint64_t>(parameters.integer("seed")));
  const std::uint32_t frames = frames_of(parameters);
  const auto pieces =
      pieces_of(mesh, static_cast<std::size_t>(parameters.integer("parts")), random);
  std::vector<Shard> shards;
  std::vector<Flight> flights;
  RigidParts parts;
  for (const std::vector<Corners>& piece : pieces) {
    shards.push_back(shard_of(mesh, piece));
    flights.push_back(flight_of(shards.back(), random));
    const auto& vertices = shards.back().vertices;
    parts.vertices.insert(parts.vertices.end(), vertices.begin(), vertices.end());
    parts.ends.push_back(parts.vertices.size());
  }
  parts.place = [flights = std::move(flights), frames](std::size_t part, std::uint32_t frame) {
    return flights[part].at(static_cast<double>(frame) / (frames - 1));
  };
  for (const glm::dvec3& place : parts.placed(0)) builder.add_vertex(place);
  std::uint32_t first = 0;
  for (const Shard& shard : shards) {
    const auto add = [&](const std::vector<Corners>& triangles, const glm::vec3& color) {
      builder.set_surface({.color = color, .diffuse = 0.8F, .specular = 0.2F, .shine = 30.0F});
      for (const auto& [a, b, c] : triangles) {
        builder.add_polygon(std::array{first + a, first + b, first + c});
      }
    };
    add(shard.outer, {0.36F, 0.50F, 0.62F});
    add(shard.broken, {0.95F, 0.55F, 0.18F});
    first += static_cast<std::uint32_t>(shard.vertices.size());
  }
  return with_moving_vertices(
      std::move(builder).build(), frames,
      [parts = std::move(parts)](std::uint32_t frame) { return parts.placed(frame); });
}

}  // namespace

void register_exploding_mesh(Catalogue& catalogue) {
  catalogue.add(
      {.name = "exploding-mesh",
       .summary = "The sphere of bumpy as a thick shell that breaks into turning parts, which fly "
                  "apart",
       .parameters = {integer_parameter("parts", 60, 2, 1000, "maximum number of parts"),
                      integer_parameter("seed", 7, 0, 0xFFFFFFFF, "seed of the random numbers"),
                      integer_parameter("triangles", 9408, 12, 10000000,
                                        "number of triangles outside, rounded to 12 k^2; the scene "
                                        "has more than twice as many"),
                      frames_parameter()},
       .size_parameter = "triangles",
       .animate = animate});
}

}  // namespace beambench::scenes::generators

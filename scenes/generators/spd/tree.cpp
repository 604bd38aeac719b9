#include <array>
#include <numbers>

#include <glm/mat3x3.hpp>

#include "scenes/base/portable_math.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/generators/spd/spd_sky.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kWidthOfHeight = 0.15;  // base radius divided by a branch's unshrunk length
constexpr double kTaper = 0.67;          // a branch's upper radius divided by its lower one

/// How a branch grows from the end of another (Aono and Kunii, IEEE CG&A 4(5), 1984).
struct Growth {
  double bend;         ///< degrees away from the parent's direction
  double divergence;   ///< degrees around the parent's direction
  double contraction;  ///< factor of the length
};
constexpr std::array<Growth, 2> kGrowths = {{{40.0, 90.0, 0.65}, {25.0, 230.0, 0.70}}};

/// Returns the matrix from a branch's own axes to its parent's: turns about x, turns about z,
/// shrinks.
glm::dmat3 relative_axes(const Growth& growth) {
  const double bend = growth.bend * std::numbers::pi / 180.0;
  const double turn = growth.divergence * std::numbers::pi / 180.0;
  const double cb = portable_cos(bend);
  const double sb = portable_sin(bend);
  const double ct = portable_cos(turn);
  const double st = portable_sin(turn);
  // The matrix is given by columns.
  return growth.contraction * glm::dmat3(ct, st, 0.0, -st * cb, ct * cb, sb, st * sb, -ct * sb, cb);
}

using Branching = std::array<glm::dmat3, 2>;

/// Adds a branch, a sphere on its end, and everything that grows from it. The z column of `axes` is
/// the branch's direction.
void grow(SceneBuilder& builder, const Branching& branching, const glm::dmat3& axes,
          const glm::dvec3& base, double radius, std::int64_t generations) {
  const glm::dvec3 end = base + axes[2];
  builder.add_cone(base, radius, end, radius * kTaper);
  builder.add_sphere(end, radius * kTaper);
  if (generations == 0) return;
  for (const glm::dmat3& relative : branching) {
    grow(builder, branching, axes * relative, end, radius * kTaper, generations - 1);
  }
}

Scene generate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  builder.add_camera({.from = {4.5F, 0.4F, 2.0F},
                      .at = {0.0F, 0.0F, 1.5F},
                      .up = {0.0F, 0.0F, 1.0F},
                      .hither = 1.0F});
  builder.set_background(kSpdSky);
  builder.add_light({-5.0, 5.0, 50.0});
  builder.add_light({30.0, -30.0, 30.0});
  builder.add_light({-40.0, -30.0, 20.0});
  builder.add_light({10.0, 30.0, 40.0});
  builder.add_light({-30.0, 40.0, 10.0});
  builder.add_light({50.0, 25.0, 20.0});
  builder.add_light({-10.0, -60.0, 30.0});

  builder.set_surface({.color = {0.2F, 0.7F, 0.2F}});
  builder.add_polygon(std::array<glm::dvec3, 4>{
      {{50.0, 50.0, 0.0}, {-50.0, 50.0, 0.0}, {-50.0, -50.0, 0.0}, {50.0, -50.0, 0.0}}});
  builder.set_surface({.color = {0.55F, 0.4F, 0.2F}});
  const Branching branching = {relative_axes(kGrowths[0]), relative_axes(kGrowths[1])};
  grow(builder, branching, glm::dmat3(1.0), glm::dvec3(0.0), kWidthOfHeight,
       parameters.integer("n"));
  return std::move(builder).build();
}

}  // namespace

void register_tree(Catalogue& catalogue) {
  catalogue.add({"tree",
                 "Tree of 2^(n+1) - 1 cones and as many spheres on a field (Haines's SPD)",
                 {integer_parameter("n", 11, 0, 22, "generations of branches out of the trunk")},
                 generate,
                 "n"});
}

}  // namespace beambench::scenes::generators

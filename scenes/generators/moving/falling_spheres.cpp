#include <cmath>
#include <utility>
#include <vector>

#include "scenes/catalogue.hpp"
#include "scenes/generators/moving/motion.hpp"
#include "scenes/generators/thesis/escena1.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {
namespace {

constexpr double kFloor = -12.0;
constexpr double kGravity = 40.0;  // per (total time)^2
constexpr double kBounce = 0.55;   // the share of its speed kept after a bounce
constexpr double kSpread = 0.9;    // rolling distance divided by distance from the axis

/// Returns the height of a ball above its resting position, for a fall from `height`.
double height_at(double height, double time) {
  const double first = std::sqrt(2.0 * height / kGravity);  // time until it touches the floor
  if (time < first) return height - 0.5 * kGravity * time * time;
  double left = time - first;
  double speed = kGravity * first;
  for (int bounces = 0; bounces < 64; ++bounces) {
    speed *= kBounce;
    const double flight = 2.0 * speed / kGravity;
    if (left < flight) return left * (speed - 0.5 * kGravity * left);
    left -= flight;
  }
  return 0.0;
}

/// Returns the center of a ball, which falls, bounces and, after touching the floor, moves outward.
glm::dvec3 center_at(const Ball& ball, double time) {
  const glm::dvec3& c = ball.center;
  const double height = c.z - ball.radius - kFloor;
  const double touched = std::sqrt(2.0 * height / kGravity);
  const double way = time > touched ? 1.0 + kSpread * (time - touched) : 1.0;
  return {way * c.x, way * c.y, kFloor + ball.radius + height_at(height, time)};
}

Animation animate(const Parameters& parameters) {
  SceneBuilder builder(parameters.label());
  add_wide_camera(builder, "default", {38.0, -45.0, 17.0}, {0.0, 0.0, -5.0}, 35.0F);
  add_wide_camera(builder, "floor", {30.0, -30.0, -9.0}, {0.0, 0.0, -6.0}, 38.0F);
  light_motion(builder, 22.0);
  const std::vector<Ball> balls = scattered_balls(
      parameters.integer("spheres"), static_cast<std::uint64_t>(parameters.integer("seed")));
  const std::uint32_t frames = frames_of(parameters);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    builder.set_surface(surface_of_ball(i, balls.size()));
    builder.add_sphere(center_at(balls[i], 0.0), balls[i].radius);
  }
  add_floor(builder, 75.0, kFloor);
  Scene scene = std::move(builder).build();
  Pose still = pose_of(scene);
  auto pose = [still = std::move(still), balls, frames](std::uint32_t frame) {
    Pose moved = still;
    const double time = 1.5 * frame / (frames - 1);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      moved.spheres[i].center =
          glm::vec3(center_at(balls[i], time)) + 0.0F;  // rounds as the builder does
    }
    return moved;
  };
  return {std::move(scene), frames, std::move(pose)};
}

}  // namespace

void register_falling_spheres(Catalogue& catalogue) {
  catalogue.add(
      {.name = "falling-spheres",
       .summary = "The spheres of escena1 fall onto a floor, bounce and spread over it",
       .parameters = {integer_parameter("seed", 1999, 0, 0xFFFFFFFF, "seed of the random numbers"),
                      integer_parameter("spheres", 430, 1, 10000000, "number of spheres"),
                      frames_parameter()},
       .size_parameter = "spheres",
       .animate = animate});
}

}  // namespace beambench::scenes::generators

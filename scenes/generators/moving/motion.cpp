#include "scenes/generators/moving/motion.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/vec4.hpp>

#include "scenes/base/portable_math.hpp"

namespace beambench::scenes::generators {

Animation with_moving_vertices(Scene scene, std::uint32_t frames, VertexPlaces places) {
  Pose still = pose_of(scene);
  auto pose = [still = std::move(still), places = std::move(places)](std::uint32_t frame) {
    Pose moved = still;
    auto vertex = moved.vertices.begin();
    for (const glm::dvec3& place : places(frame)) {
      *vertex++ = glm::vec3(place) + 0.0F;  // rounds as the builder does
    }
    return moved;
  };
  return {std::move(scene), frames, std::move(pose)};
}

std::vector<glm::dvec3> RigidParts::placed(std::uint32_t frame) const {
  std::vector<glm::dvec3> places;
  places.reserve(vertices.size());
  for (std::size_t part = 0; part < ends.size(); ++part) {
    const glm::dmat4 matrix = place(part, frame);
    while (places.size() < ends[part]) {
      places.emplace_back(matrix * glm::dvec4(vertices[places.size()], 1.0));
    }
  }
  return places;
}

std::uint32_t frames_of(const Parameters& parameters) {
  return static_cast<std::uint32_t>(parameters.integer("frames"));
}

std::uint32_t cells_for(std::int64_t triangles) {
  const double k = std::sqrt(static_cast<double>(triangles) / 2.0);
  return static_cast<std::uint32_t>(std::max<std::int64_t>(1, std::llround(k)));
}

void add_wide_camera(SceneBuilder& builder, const std::string& name, const glm::dvec3& from,
                     const glm::dvec3& at, float angle) {
  Camera camera;
  camera.name = name;
  camera.from = glm::vec3(from);
  camera.at = glm::vec3(at);
  camera.up = {0.0F, 0.0F, 1.0F};
  camera.angle = angle;
  camera.aspect = 4.0F / 3.0F;
  camera.width = 640;
  camera.height = 480;
  builder.add_camera(camera);
}

void add_floor(SceneBuilder& builder, double radius, double height) {
  constexpr int kCorners = 48;
  std::vector<glm::dvec3> corners;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = kFullTurn * i / kCorners;
    corners.emplace_back(radius * portable_cos(angle), radius * portable_sin(angle), height);
  }
  builder.set_surface(
      {.color = {0.72F, 0.70F, 0.66F}, .diffuse = 0.95F, .specular = 0.0F, .shine = 5.0F});
  builder.add_polygon(corners);
}

void light_motion(SceneBuilder& builder, double size) {
  builder.set_background({0.55, 0.68, 0.82});
  builder.add_light(size * glm::dvec3(1.5, -2.0, 3.0), {0.85, 0.82, 0.78});
  builder.add_light(size * glm::dvec3(3.0, 2.0, 2.0), {0.40, 0.42, 0.46});
}

}  // namespace beambench::scenes::generators

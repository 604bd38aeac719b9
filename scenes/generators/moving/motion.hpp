#pragma once
// The common part of the moving scenes.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "scenes/animation.hpp"
#include "scenes/base/parameters.hpp"
#include "scenes/scene.hpp"
#include "scenes/scene_builder.hpp"

namespace beambench::scenes::generators {

/// A full turn in radians.
inline constexpr double kFullTurn = 6.283185307179586;

/// Returns the positions of the moving vertices in a frame, which in frame 0 are the scene's own.
using VertexPlaces = std::function<std::vector<glm::dvec3>(std::uint32_t frame)>;

/// Returns an animation in which a scene's first vertices move. All other vertices, spheres, cones
/// and normals stay.
Animation with_moving_vertices(Scene scene, std::uint32_t frames, VertexPlaces places);

/// Rigid parts. The vertices of each part follow those of the previous one.
struct RigidParts {
  std::vector<glm::dvec3> vertices;  ///< positions at rest
  std::vector<std::size_t> ends{};   ///< end of each part's vertices
  /// Returns the matrix that moves a part from rest to its position in a frame.
  std::function<glm::dmat4(std::size_t part, std::uint32_t frame)> place{};

  std::vector<glm::dvec3> placed(std::uint32_t frame) const;
};

/// Returns the value of `frames_parameter`.
std::uint32_t frames_of(const Parameters& parameters);

/// Returns the k, at least 1, for which 2 k^2 is nearest to a number of triangles.
std::uint32_t cells_for(std::int64_t triangles);

/// Adds a camera with a landscape format.
void add_wide_camera(SceneBuilder& builder, const std::string& name, const glm::dvec3& from,
                     const glm::dvec3& at, float angle);

/// Adds a round floor, a polygon of 48 corners, about the z axis.
void add_floor(SceneBuilder& builder, double radius, double height);

/// Adds the lights and the background of these scenes, for a scene of this `size` around the
/// origin.
void light_motion(SceneBuilder& builder, double size);

}  // namespace beambench::scenes::generators

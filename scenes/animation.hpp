#pragma once
// A scene that moves: frames over fixed primitives whose coordinates change.

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/primitive.hpp"
#include "scenes/scene.hpp"

namespace beambench::scenes {

/// The coordinates of one frame, in arrays of the sizes that the scene's own have. Radii and the
/// sides of primitives stay those of the scene.
struct Pose {
  std::vector<glm::vec3> vertices;
  std::vector<glm::vec3> normals;
  std::vector<Sphere> spheres;
  std::vector<Cone> cones;
};

/// Returns the coordinates that a scene has now.
Pose pose_of(const Scene& scene);

/// Gives a scene the coordinates of a pose, in place, and computes its bounds. Primitives may be
/// degenerate in a frame: no ray hits a triangle without area or a cone without length. Throws
/// InputError naming the frame and the primitive where a coordinate is NaN, infinite or beyond
/// `kLargestNumber`, or a count or a radius differs from the scene's; the scene is then as before.
void set_pose(Scene& scene, const Pose& pose, std::uint32_t frame);

/// A scene and how it moves.
struct Animation {
  Scene scene;               ///< as in frame 0
  std::uint32_t frames = 1;  ///< 1: it does not move
  /// Returns the coordinates of a frame, which do not depend on those of any other; null where the
  /// scene does not move.
  std::function<Pose(std::uint32_t frame)> pose{};
};

/// The name of a scene and the frame at its end, of what a user types and of `Scene::name`:
/// `waving-sheet:n=64@7`.
struct FrameName {
  std::string_view scene;
  std::optional<std::uint32_t> frame;  ///< nothing where none is named
};
FrameName divide_frame(std::string_view name);

/// Moves the animation's scene to a frame. Throws InputError where there is no such frame, or like
/// `set_pose`.
void show_frame(Animation& animation, std::uint32_t frame);

}  // namespace beambench::scenes

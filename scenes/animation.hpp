#pragma once
// A scene that moves: a fixed set of primitives whose coordinates change from frame to frame.

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/primitive.hpp"
#include "scenes/scene.hpp"

namespace beambench::scenes {

/// The coordinates of one frame, in arrays of the same sizes as the scene's. The radii and visible
/// sides of primitives equal the scene's.
struct Pose {
  std::vector<glm::vec3> vertices;
  std::vector<glm::vec3> normals;
  std::vector<Sphere> spheres;
  std::vector<Cone> cones;
};

/// Returns a scene's current coordinates.
Pose pose_of(const Scene& scene);

/// Sets a scene's coordinates to those of a pose, in place, and computes its bounds. Primitives may
/// be degenerate in a frame: no ray hits a triangle without area or a cone without length. Throws
/// an InputError that names the frame and the primitive if a coordinate is NaN, infinite or beyond
/// `kLargestNumber`, or if a count or a radius differs from the scene's; the scene is then
/// unchanged.
void set_pose(Scene& scene, const Pose& pose, std::uint32_t frame);

/// A scene and its motion.
struct Animation {
  Scene scene;               ///< the scene in frame 0
  std::uint32_t frames = 1;  ///< number of frames; 1: static
  /// Returns the coordinates of a frame, independently of all other frames. Null if the scene is
  /// static.
  std::function<Pose(std::uint32_t frame)> pose{};
};

/// A scene's name and the frame number at its end, as a user types it and in `Scene::name`:
/// `waving-sheet:n=64@7`.
struct FrameName {
  std::string_view scene;
  std::optional<std::uint32_t> frame;  ///< empty if the name has no frame number
};
FrameName divide_frame(std::string_view name);

/// Moves the animation's scene to a frame. Throws InputError if there is no such frame, and also
/// throws like `set_pose`.
void show_frame(Animation& animation, std::uint32_t frame);

}  // namespace beambench::scenes

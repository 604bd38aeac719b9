#pragma once
// The scene over which structures are built and against which rays are traced.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "scenes/bounds.hpp"
#include "scenes/camera.hpp"
#include "scenes/primitive.hpp"
#include "scenes/surface.hpp"

namespace beambench::scenes {

/// A point light; color components may exceed 1.
struct Light {
  glm::vec3 position;
  glm::vec3 color{1.0F};
};

/// A scene in single precision, rounded once, so that all structures receive the same bits. Built
/// by `SceneBuilder`, which excludes NaNs, infinities, coordinates beyond 1e9 and degenerate
/// primitives. All indices have 32 bits. Treat it as read-only once built.
struct Scene {
  std::string name;             ///< printable; for a file, `path_of_name` restores the path
  std::vector<Camera> cameras;  ///< never empty; the first is the default
  glm::vec3 background{0.0F};
  std::vector<Light> lights;
  std::vector<Surface> surfaces;  ///< never empty when there are primitives

  std::vector<Primitive> primitives;  ///< indexed by PrimitiveId, in the order they were added
  std::vector<Sphere> spheres;
  std::vector<Cone> cones;
  std::vector<Polygon> polygons;
  std::vector<Triangle> triangles;  ///< the polygons' surfaces
  std::vector<glm::vec3> vertices;
  std::vector<std::uint32_t> corners;  ///< polygon corners: indices into vertices
  std::vector<glm::vec3> normals;      ///< corner normals of smooth polygons

  Bounds bounds;  ///< bounds of all primitives; empty for an empty scene

  std::uint32_t frame = 0;  ///< frame of a scene that moves (animation.hpp)
  /// The same scene in frame 0; null if this is frame 0.
  std::shared_ptr<const Scene> first_frame{};
};

/// Returns the tight bounds of one primitive, rounded outward to float (a sphere's c + r may not be
/// representable). A cone's bounds are the box of its two end discs.
Bounds primitive_bounds(const Scene& scene, PrimitiveId id);

/// Returns the bounds of all primitives together, which are empty if there are no primitives.
Bounds bounds_of_all(const Scene& scene);

/// Returns the bytes of the scene's arrays, including spare capacity.
std::size_t memory_bytes(const Scene& scene);

/// Returns a 64-bit hash of everything that rays can hit: primitives, their coordinates and order
/// (XXH3 over the bits; not surfaces, lights or cameras). The hash is the same on every machine.
std::uint64_t scene_hash(const Scene& scene);

/// Returns the camera of that name. Throws InputError with a list of the scene's cameras.
const Camera& find_camera(const Scene& scene, std::string_view name);

}  // namespace beambench::scenes

#include "scenes/scene.hpp"

namespace beambench::scenes {
namespace {

template <typename T>
std::size_t bytes_of(const std::vector<T>& list) {
  return list.capacity() * sizeof(T);
}

}  // namespace

std::size_t memory_bytes(const Scene& scene) {
  return sizeof(scene) + bytes_of(scene.cameras) + bytes_of(scene.lights) +
         bytes_of(scene.surfaces) + bytes_of(scene.primitives) + bytes_of(scene.spheres) +
         bytes_of(scene.cones) + bytes_of(scene.polygons) + bytes_of(scene.triangles) +
         bytes_of(scene.vertices) + bytes_of(scene.corners) + bytes_of(scene.normals);
}

}  // namespace beambench::scenes

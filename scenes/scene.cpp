#include "scenes/scene.hpp"

#define XXH_INLINE_ALL

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/geometric.hpp>
#include <xxhash.h>

#include "scenes/base/error.hpp"
#include "scenes/base/nearest_name.hpp"
#include "scenes/base/printable.hpp"

namespace beambench::scenes {
namespace {

static_assert(std::endian::native == std::endian::little,
              "swap the bytes of hashed words, so that hashes are equal on every machine");

/// Feeds 32-bit words to XXH3 in blocks.
class Fingerprint {
 public:
  Fingerprint() { XXH3_64bits_reset(&state_); }

  void add(std::uint32_t word) {
    if (used_ == block_.size()) flush();
    block_[used_++] = word;
  }
  void add(float number) { add(std::bit_cast<std::uint32_t>(number)); }
  void add(const glm::vec3& point) {
    add(point.x);
    add(point.y);
    add(point.z);
  }

  std::uint64_t digest() {
    flush();
    return XXH3_64bits_digest(&state_);
  }

 private:
  void flush() {
    XXH3_64bits_update(&state_, block_.data(), used_ * sizeof(std::uint32_t));
    used_ = 0;
  }

  XXH3_state_t state_;
  std::array<std::uint32_t, 1024> block_;
  std::size_t used_ = 0;
};

void add_polygon(Fingerprint& fingerprint, const Scene& scene, const Polygon& polygon) {
  fingerprint.add(polygon.corner_count);
  for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
    fingerprint.add(scene.vertices[scene.corners[polygon.first_corner + i]]);
  }
}

template <typename T>
std::size_t bytes_of(const std::vector<T>& list) {
  return list.capacity() * sizeof(T);
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Returns the largest float that is not above a + b, using the double sum's rounding error from
/// Knuth's two-sum.
float sum_rounded_down(double a, double b) {
  const double sum = a + b;
  const double part = sum - a;
  const double lost = (a - (sum - part)) + (b - part);
  const auto rounded = static_cast<float>(sum);
  const double excess = static_cast<double>(rounded) - sum;  // exact, because both are so close
  return excess > lost ? std::nextafter(rounded, -kInfinity) : rounded;
}

float sum_rounded_up(double a, double b) { return -sum_rounded_down(-a, -b); }

Bounds box_around(const glm::vec3& center, const glm::dvec3& half_size) {
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.lower[axis] = sum_rounded_down(center[axis], -half_size[axis]);
    bounds.upper[axis] = sum_rounded_up(center[axis], half_size[axis]);
  }
  return bounds;
}

Bounds cone_bounds(const Cone& cone) {
  // A disc of radius r and unit normal n extends r sqrt(1 - n_i^2) along axis i. `kOutward` covers
  // the few roundings of this computation.
  constexpr double kOutward = 1.0 + 0x1p-48;
  const glm::dvec3 axis = glm::dvec3(cone.apex) - glm::dvec3(cone.base);
  const glm::dvec3 square = axis * axis;
  const glm::dvec3 across(square.y + square.z, square.z + square.x, square.x + square.y);
  const double length_squared = square.x + square.y + square.z;
  // Frames of an animation may have cones without length, which no ray hits.
  const glm::dvec3 reach =
      length_squared > 0.0 ? glm::sqrt(across / length_squared) * kOutward : glm::dvec3(0.0);
  Bounds bounds = box_around(cone.base, static_cast<double>(cone.base_radius) * reach);
  bounds.include(box_around(cone.apex, static_cast<double>(cone.apex_radius) * reach));
  return bounds;
}

Bounds polygon_bounds(const Scene& scene, const Polygon& polygon) {
  Bounds bounds;
  for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
    bounds.include(scene.vertices[scene.corners[polygon.first_corner + i]]);
  }
  return bounds;
}

}  // namespace

std::uint64_t scene_hash(const Scene& scene) {
  Fingerprint fingerprint;
  for (const Primitive& primitive : scene.primitives) {
    fingerprint.add(static_cast<std::uint32_t>(primitive.kind));
    switch (primitive.kind) {
      case PrimitiveKind::kSphere: {
        const Sphere& sphere = scene.spheres[primitive.index];
        fingerprint.add(sphere.center);
        fingerprint.add(sphere.radius);
        fingerprint.add(std::uint32_t{sphere.inside_only});
        break;
      }
      case PrimitiveKind::kCone: {
        const Cone& cone = scene.cones[primitive.index];
        fingerprint.add(cone.base);
        fingerprint.add(cone.base_radius);
        fingerprint.add(cone.apex);
        fingerprint.add(cone.apex_radius);
        fingerprint.add(std::uint32_t{cone.inside_only});
        break;
      }
      case PrimitiveKind::kPolygon:
        add_polygon(fingerprint, scene, scene.polygons[primitive.index]);
        break;
    }
  }
  return fingerprint.digest();
}

Bounds bounds_of_all(const Scene& scene) {
  Bounds bounds;
  for (PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    bounds.include(primitive_bounds(scene, id));
  }
  return bounds;
}

std::size_t memory_bytes(const Scene& scene) {
  return sizeof(scene) + bytes_of(scene.cameras) + bytes_of(scene.lights) +
         bytes_of(scene.surfaces) + bytes_of(scene.primitives) + bytes_of(scene.spheres) +
         bytes_of(scene.cones) + bytes_of(scene.polygons) + bytes_of(scene.triangles) +
         bytes_of(scene.vertices) + bytes_of(scene.corners) + bytes_of(scene.normals);
}

Bounds primitive_bounds(const Scene& scene, PrimitiveId id) {
  const Primitive& primitive = scene.primitives[id];
  switch (primitive.kind) {
    case PrimitiveKind::kSphere: {
      const Sphere& sphere = scene.spheres[primitive.index];
      return box_around(sphere.center, glm::dvec3(sphere.radius));
    }
    case PrimitiveKind::kCone:
      return cone_bounds(scene.cones[primitive.index]);
    case PrimitiveKind::kPolygon:
      break;
  }
  return polygon_bounds(scene, scene.polygons[primitive.index]);
}

const Camera& find_camera(const Scene& scene, std::string_view name) {
  std::vector<std::string> names;
  const std::string wanted = printable(name);
  for (const Camera& camera : scene.cameras) {
    if (camera.name == wanted) return camera;
    names.push_back(camera.name);
  }
  throw InputError(fmt::format("the scene {} has no camera '{}'; {}choose from: {}", scene.name,
                               excerpt(name), did_you_mean(name, names), fmt::join(names, ", ")));
}

}  // namespace beambench::scenes

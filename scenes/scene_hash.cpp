#define XXH_INLINE_ALL
#include <array>
#include <bit>

#include <xxhash.h>

#include "scenes/scene.hpp"

namespace beambench::scenes {
namespace {

static_assert(std::endian::native == std::endian::little,
              "hash the words byte-swapped, so that hashes stay equal on every machine");

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

}  // namespace beambench::scenes

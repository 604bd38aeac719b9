#include "scenes/formats/nff/nff_writer.hpp"

#include <algorithm>
#include <iterator>
#include <span>
#include <string>
#include <string_view>

#include <fmt/compile.h>
#include <fmt/format.h>

#include "scenes/formats/nff/nff_tokens.hpp"

namespace beambench::scenes::nff {
namespace {

class NffWriter {
 public:
  explicit NffWriter(std::ostream& stream) : stream_(stream) {}

  void write(const Scene& scene);

 private:
  static constexpr std::size_t kBlock = 1U << 16U;  // bytes passed to the stream at a time

  void write(const Camera& camera);
  void write(const Surface& surface);
  void write(const Sphere& sphere);
  void write(const Cone& cone);
  void write(const Scene& scene, const Polygon& polygon);

  /// Writes one line: words and numbers separated by blanks.
  template <typename... Values>
  void line(const Values&... values) {
    const std::size_t start = buffer_.size();
    (put(values, buffer_.size() > start), ...);
    buffer_.push_back('\n');
    if (buffer_.size() >= kBlock) flush();
  }

  template <typename Value>
  void put(const Value& value, bool blank_before) {
    if (blank_before) buffer_.push_back(' ');
    fmt::format_to(std::back_inserter(buffer_), FMT_COMPILE("{}"), value);
  }
  void put(const glm::vec3& point, bool blank_before) {
    put(point.x, blank_before);
    put(point.y, true);
    put(point.z, true);
  }

  void flush() {
    stream_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    buffer_.clear();
  }

  std::ostream& stream_;
  fmt::memory_buffer buffer_;
};

/// Returns the name in a form that fits a one-line comment.
std::string one_line(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return name;
}

void NffWriter::write(const Scene& scene) {
  line("#", one_line(scene.name));
  line("b", scene.background);
  for (const Camera& camera : scene.cameras) write(camera);
  for (const Light& light : scene.lights) line("l", light.position, light.color);
  const Primitive* previous = nullptr;
  for (const Primitive& primitive : scene.primitives) {
    if (previous == nullptr || previous->surface != primitive.surface) {
      write(scene.surfaces[primitive.surface]);
    }
    previous = &primitive;
    switch (primitive.kind) {
      case PrimitiveKind::kSphere:
        write(scene.spheres[primitive.index]);
        break;
      case PrimitiveKind::kCone:
        write(scene.cones[primitive.index]);
        break;
      case PrimitiveKind::kPolygon:
        write(scene, scene.polygons[primitive.index]);
        break;
    }
  }
  flush();
}

void NffWriter::write(const Camera& camera) {
  line("v");
  line("from", camera.from);
  line("at", camera.at);
  line("up", camera.up);
  line("angle", camera.angle);
  line("hither", camera.hither);
  line("resolution", camera.width, camera.height);
  line(kOwnComment, "name", camera.name);
  line(kOwnComment, "aspect", camera.aspect);
}

void NffWriter::write(const Surface& surface) {
  const std::string_view word = finish_word(surface.finish);
  if (surface.finish != Finish::kPlain && surface == finished_surface(surface.finish)) {
    line(word);
    return;
  }
  line(word, surface.color, surface.diffuse, surface.specular, surface.shine, surface.transmittance,
       surface.refraction_index);
}

/// Returns the radius in NFF's convention: negative for surfaces visible only from the inside.
float signed_radius(float radius, bool inside_only) { return inside_only ? 0.0F - radius : radius; }

void NffWriter::write(const Sphere& sphere) {
  line("s", sphere.center, signed_radius(sphere.radius, sphere.inside_only));
}

void NffWriter::write(const Cone& cone) {
  line("c");
  line(cone.base, signed_radius(cone.base_radius, cone.inside_only));
  line(cone.apex, signed_radius(cone.apex_radius, cone.inside_only));
}

void NffWriter::write(const Scene& scene, const Polygon& polygon) {
  const bool smooth = polygon.first_normal != Polygon::kFlat;
  line(smooth ? "pp" : "p", polygon.corner_count);
  for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
    const glm::vec3& vertex = scene.vertices[scene.corners[polygon.first_corner + i]];
    if (smooth) {
      line(vertex, scene.normals[polygon.first_normal + i]);
    } else {
      line(vertex);
    }
  }
}

}  // namespace

void write_nff(const Scene& scene, std::ostream& stream) { NffWriter(stream).write(scene); }

}  // namespace beambench::scenes::nff

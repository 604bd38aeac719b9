#include "harness/render/picture/point_marks.hpp"

#include <cmath>
#include <optional>
#include <string>

#include <glm/vec2.hpp>

#include "harness/render/picture/projection.hpp"

namespace beambench::render {
namespace {

constexpr int kRadius = 2;  // pixels; the frame is one more
constexpr glm::vec3 kFrameColor(0.0F);

/// Returns the pixel in which a point appears; nothing if it is not in the picture.
std::optional<glm::ivec2> pixel_of(const glm::dvec3& point, const Projection& projection,
                                   const Image& image) {
  if (!(projection.depth(point) > 0.0)) return std::nullopt;
  const glm::dvec2 place = projection.place(point);
  if (!(0.0 <= place.x && place.x < image.width() && 0.0 <= place.y && place.y < image.height())) {
    return std::nullopt;
  }
  return glm::ivec2(static_cast<int>(place.x), static_cast<int>(place.y));
}

void fill_disc(Image& image, const glm::ivec2& center, int radius, const glm::vec3& color) {
  for (int dy = -radius; dy <= radius; ++dy) {
    for (int dx = -radius; dx <= radius; ++dx) {
      const glm::ivec2 at = center + glm::ivec2(dx, dy);
      const bool inside = dx * dx + dy * dy <= radius * radius + 1;
      if (!inside || at.x < 0 || at.y < 0 || at.x >= image.width() || at.y >= image.height()) {
        continue;
      }
      image.at(at.x, at.y) = color;
    }
  }
}

}  // namespace

std::vector<LegendEntry> mark_points(Image& image, const accel::PrimaryRays& rays,
                                     std::span<const PointGroup> groups) {
  dim(image);
  const Projection projection(rays);
  std::vector<LegendEntry> legend;
  std::size_t outside = 0;
  for (const PointGroup& group : groups) {
    std::vector<glm::ivec2> pixels;
    for (const glm::dvec3& point : group.points) {
      if (const auto pixel = pixel_of(point, projection, image)) {
        pixels.push_back(*pixel);
      } else {
        ++outside;
      }
    }
    // All frames first, so that no frame hides a dot of its own group.
    for (const glm::ivec2& pixel : pixels) fill_disc(image, pixel, kRadius + 1, kFrameColor);
    for (const glm::ivec2& pixel : pixels) fill_disc(image, pixel, kRadius, group.category.color);
    legend.push_back({group.category.name, group.category.color, group.points.size()});
  }
  if (outside > 0) legend.push_back({"outside of this picture", kFrameColor, outside});
  return legend;
}

}  // namespace beambench::render

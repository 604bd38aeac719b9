#include "harness/render/picture/category_map.hpp"

#include <algorithm>
#include <cstdlib>

#include "harness/render/picture/category_legend.hpp"

namespace beambench::render {
namespace {

constexpr std::size_t kFew = 40;  // pixels of a category that get a frame each
constexpr int kFrame = 5;         // from the pixel to its frame

std::vector<std::size_t> count_pixels(const CategoryMap& map) {
  std::vector<std::size_t> counts(map.categories.size(), 0);
  for (const std::uint8_t category : map.pixels) {
    if (category != CategoryMap::kNone) ++counts[category];
  }
  return counts;
}

/// A square around a pixel, as far as it lies in the picture.
void frame(Image& image, int x, int y, const glm::vec3& color) {
  for (int dy = -kFrame; dy <= kFrame; ++dy) {
    for (int dx = -kFrame; dx <= kFrame; ++dx) {
      if (std::max(std::abs(dx), std::abs(dy)) != kFrame) continue;
      const bool inside =
          x + dx >= 0 && x + dx < image.width() && y + dy >= 0 && y + dy < image.height();
      if (inside) image.at(x + dx, y + dy) = color;
    }
  }
}

void draw_pixels(Image& image, const CategoryMap& map) {
  std::size_t index = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const std::uint8_t category = map.pixels[index++];
      image.at(x, y) =
          category == CategoryMap::kNone ? dimmed(image.at(x, y)) : map.categories[category].color;
    }
  }
}

void draw_frames(Image& image, const CategoryMap& map, const std::vector<std::size_t>& counts) {
  std::size_t index = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const std::uint8_t category = map.pixels[index++];
      if (category == CategoryMap::kNone || counts[category] > kFew) continue;
      frame(image, x, y, map.categories[category].color);
    }
  }
}

}  // namespace

Image draw_category_map(const CategoryMap& map, const Image& ground) {
  const std::vector<std::size_t> counts = count_pixels(map);
  Image image = ground;
  draw_pixels(image, map);
  draw_frames(image, map, counts);
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    entries.push_back({map.categories[i].name, map.categories[i].color, counts[i]});
  }
  return with_legend(image, map.title, entries);
}

}  // namespace beambench::render

#include "harness/render/picture/category_map.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "harness/render/picture/color.hpp"
#include "harness/render/picture/text.hpp"

namespace beambench::render {
namespace {

constexpr float kDimmed = 0.35F;

/// Relative luminance of linear sRGB (IEC 61966-2-1).
float luminance(const glm::vec3& c) { return glm::dot(c, glm::vec3(0.2126F, 0.7152F, 0.0722F)); }

void fill(Image& image, int left, int top, int width, int height, const glm::vec3& color) {
  for (int y = top; y < top + height; ++y) {
    for (int x = left; x < left + width; ++x) image.at(x, y) = color;
  }
}

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
  for (std::size_t i = 0; i < map.pixels.size(); ++i) {
    glm::vec3& pixel = image.pixels()[i];
    const std::uint8_t category = map.pixels[i];
    pixel = category == CategoryMap::kNone ? dimmed(pixel) : map.categories[category].color;
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

namespace okabe_ito {
const glm::vec3 kSkyBlue = linear_from_srgb(glm::vec3(86, 180, 233) / 255.0F);
const glm::vec3 kYellow = linear_from_srgb(glm::vec3(240, 228, 66) / 255.0F);
const glm::vec3 kBluishGreen = linear_from_srgb(glm::vec3(0, 158, 115) / 255.0F);
const glm::vec3 kVermillion = linear_from_srgb(glm::vec3(213, 94, 0) / 255.0F);
}  // namespace okabe_ito

Image with_legend(const Image& picture, const std::string& title,
                  std::span<const LegendEntry> entries) {
  constexpr std::size_t kSwatch = 3;  // in characters
  std::vector<std::string> lines;
  std::size_t longest = title.size();
  for (const LegendEntry& entry : entries) {
    lines.push_back(fmt::format("{}: {}", entry.name, entry.count));
    longest = std::max(longest, lines.back().size() + kSwatch);
  }
  const LegendLayout layout(picture.width(), longest);
  const int line_height = (kGlyphHeight + 5) * layout.scale;
  Image image = above_legend(
      picture, layout,
      2 * layout.margin + line_height * (1 + static_cast<int>(lines.size())) - 5 * layout.scale);

  int y = picture.height() + layout.margin;
  draw_text(image, layout.margin, y, title, layout.scale, kInk);
  const int swatch = kGlyphHeight * layout.scale;
  const int text = layout.margin + static_cast<int>(kSwatch) * kGlyphAdvance * layout.scale;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    y += line_height;
    fill(image, layout.margin, y, swatch, swatch, entries[i].color);
    draw_text(image, text, y, lines[i], layout.scale, kInk);
  }
  return image;
}

glm::vec3 dimmed(const glm::vec3& color) { return glm::vec3(kDimmed * luminance(color)); }

void dim(Image& image) {
  for (glm::vec3& pixel : image.pixels()) pixel = dimmed(pixel);
}

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

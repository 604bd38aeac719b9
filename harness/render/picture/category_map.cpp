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

/// Sizes of the legend in pixels: a title, and a line for each entry.
struct LegendLayout {
  LegendLayout(int picture_width, const std::string& title, const std::vector<std::string>& lines) {
    std::size_t longest = title.size();
    for (const std::string& line : lines) longest = std::max(longest, line.size() + kSwatch);
    const int dots = static_cast<int>(longest) * kGlyphAdvance + 2 * kLegendMargin;
    scale = std::clamp(picture_width / dots, 1, 2);
    width = std::max(picture_width, dots * scale);
    line_height = (kGlyphHeight + 5) * scale;
    margin = kLegendMargin * scale;
    height = 2 * margin + line_height * (1 + static_cast<int>(lines.size())) - 5 * scale;
  }

  static constexpr std::size_t kSwatch = 3;  // in glyphs

  int scale, width, line_height, margin, height;
};

void fill(Image& image, int left, int top, int width, int height, const glm::vec3& color) {
  for (int y = top; y < top + height; ++y) {
    for (int x = left; x < left + width; ++x) image.at(x, y) = color;
  }
}

void paste(Image& image, int left, const Image& picture) {
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) image.at(left + x, y) = picture.at(x, y);
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

namespace okabe_ito {
const glm::vec3 kSkyBlue = linear_from_srgb(glm::vec3(86, 180, 233) / 255.0F);
const glm::vec3 kYellow = linear_from_srgb(glm::vec3(240, 228, 66) / 255.0F);
const glm::vec3 kBluishGreen = linear_from_srgb(glm::vec3(0, 158, 115) / 255.0F);
const glm::vec3 kVermillion = linear_from_srgb(glm::vec3(213, 94, 0) / 255.0F);
}  // namespace okabe_ito

Image with_legend(const Image& picture, const std::string& title,
                  std::span<const LegendEntry> entries) {
  std::vector<std::string> lines;
  for (const LegendEntry& entry : entries) {
    lines.push_back(fmt::format("{}: {}", entry.name, entry.count));
  }
  const LegendLayout layout(picture.width(), title, lines);
  Image image(layout.width, picture.height() + layout.height, kPaper);
  paste(image, (layout.width - picture.width()) / 2, picture);

  int y = picture.height() + layout.margin;
  draw_text(image, layout.margin, y, title, layout.scale, kInk);
  const int swatch = kGlyphHeight * layout.scale;
  const int text =
      layout.margin + static_cast<int>(LegendLayout::kSwatch) * kGlyphAdvance * layout.scale;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    y += layout.line_height;
    fill(image, layout.margin, y, swatch, swatch, entries[i].color);
    draw_text(image, text, y, lines[i], layout.scale, kInk);
  }
  return image;
}

glm::vec3 dimmed(const glm::vec3& color) { return glm::vec3(kDimmed * luminance(color)); }

void dim(Image& image) {
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) image.at(x, y) = dimmed(image.at(x, y));
  }
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

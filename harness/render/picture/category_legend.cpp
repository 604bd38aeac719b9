#include "harness/render/picture/category_legend.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "harness/render/picture/legend.hpp"
#include "harness/render/picture/srgb.hpp"
#include "harness/render/picture/text.hpp"

namespace beambench::render {

namespace okabe_ito {
const glm::vec3 kSkyBlue = linear_from_srgb(glm::vec3(86, 180, 233) / 255.0F);
const glm::vec3 kYellow = linear_from_srgb(glm::vec3(240, 228, 66) / 255.0F);
const glm::vec3 kBluishGreen = linear_from_srgb(glm::vec3(0, 158, 115) / 255.0F);
const glm::vec3 kVermillion = linear_from_srgb(glm::vec3(213, 94, 0) / 255.0F);
}  // namespace okabe_ito

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

}  // namespace

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

}  // namespace beambench::render

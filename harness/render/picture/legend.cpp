#include "harness/render/picture/legend.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numeric>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "harness/render/picture/color.hpp"

namespace beambench::render {
namespace {

constexpr int kLegendMargin = 8;     // in dots of the text
constexpr glm::vec3 kPaper(0.012F);  // linear light of the ground

constexpr std::string_view kCharacters = "0123456789abcdefghijklmnopqrstuvwxyz .,:_-+=()/";
/// The glyphs: for each character seven bytes, the rows from the top; in each row the five lowest
/// bits, with the leftmost dot in the highest.
constexpr auto kGlyphs = std::to_array<std::uint64_t>(
    {0x0E11131519110E, 0x040C040404040E, 0x0E11010608101F, 0x0E11010601110E, 0x02060A121F0202,
     0x1F101E0101110E, 0x0608101E11110E, 0x1F010204040808, 0x0E11110E11110E, 0x0E11110F01020C,
     0x00000E010F110F, 0x10101E1111111E, 0x00000E1110110E, 0x01010F1111110F, 0x00000E111F100E,
     0x0609081C080808, 0x000F11110F010E, 0x10101619111111, 0x04000C0404040E, 0x0200060202120C,
     0x10101214181412, 0x0C04040404040E, 0x00001A15151515, 0x00001619111111, 0x00000E1111110E,
     0x00001E111E1010, 0x00000F110F0101, 0x00001619101010, 0x00000F100E011E, 0x08081C08080906,
     0x0000111111130D, 0x00001111110A04, 0x0000111515150A, 0x0000110A040A11, 0x000011110F010E,
     0x00001F0204081F, 0x00000000000000, 0x00000000000C0C, 0x000000000C0408, 0x000C0C000C0C00,
     0x0000000000001F, 0x0000001F000000, 0x0004041F040400, 0x00001F001F0000, 0x02040808080402,
     0x08040202020408, 0x00010204081000});
constexpr std::uint64_t kUnknown = 0x1F11111111111F;

/// Fills a square, clipped to the picture.
void fill(Image& image, int left, int top, int size, const glm::vec3& color) {
  for (int y = std::max(top, 0); y < std::min(top + size, image.height()); ++y) {
    for (int x = std::max(left, 0); x < std::min(left + size, image.width()); ++x) {
      image.at(x, y) = color;
    }
  }
}

constexpr float kDimmed = 0.35F;

/// Returns the relative luminance of linear sRGB (IEC 61966-2-1).
float relative_luminance(const glm::vec3& c) {
  return glm::dot(c, glm::vec3(0.2126F, 0.7152F, 0.0722F));
}

constexpr std::size_t kFew = 40;   // up to this many pixels of a category are framed singly
constexpr int kFrameDistance = 5;  // from the pixel to its frame

std::vector<std::size_t> count_pixels(const CategoryMap& map) {
  std::vector<std::size_t> counts(map.categories.size(), 0);
  for (const std::uint8_t category : map.pixels) {
    if (category != CategoryMap::kNone) ++counts[category];
  }
  return counts;
}

/// Draws a square around a pixel, clipped to the picture.
void frame(Image& image, int x, int y, const glm::vec3& color) {
  for (int dy = -kFrameDistance; dy <= kFrameDistance; ++dy) {
    for (int dx = -kFrameDistance; dx <= kFrameDistance; ++dx) {
      if (std::max(std::abs(dx), std::abs(dy)) != kFrameDistance) continue;
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

constexpr std::size_t kBrightestPerMille = 995;

/// A heading, and a bar above its numbers.
struct BarLayout : LegendLayout {
  BarLayout(int picture_width, std::string_view heading)
      : LegendLayout(picture_width, heading.size()),
        bar_y(margin + (kGlyphHeight + 4) * scale),
        bar_height(8 * scale),
        numbers_y(bar_y + bar_height + 5 * scale),
        height(numbers_y + kGlyphHeight * scale + margin) {}

  int bar_y, bar_height, numbers_y, height;
  int bar_width() const { return width - 2 * margin; }
};

float largest(const HeatMap& map) {
  const auto found = std::max_element(map.values.begin(), map.values.end());
  return found == map.values.end() ? 0.0F : *found;
}

double mean(const HeatMap& map) {
  const double sum = std::accumulate(map.values.begin(), map.values.end(), 0.0);
  return map.values.empty() ? 0.0 : sum / static_cast<double>(map.values.size());
}

void draw_bar(Image& image, int top, const BarLayout& layout) {
  for (int x = 0; x < layout.bar_width(); ++x) {
    const float part = static_cast<float>(x) / static_cast<float>(layout.bar_width() - 1);
    for (int y = 0; y < layout.bar_height; ++y) {
      image.at(layout.margin + x, top + layout.bar_y + y) = heat_color(part);
    }
  }
}

/// Draws a number below its place on the bar; `part` is the fraction of the bar to its left.
void draw_number(Image& image, int top, const BarLayout& layout, double part,
                 const std::string& number) {
  const int x = layout.margin + static_cast<int>(std::lround(part * (layout.bar_width() - 1)));
  for (int y = 0; y < 3 * layout.scale; ++y) {
    image.at(x, top + layout.bar_y + layout.bar_height + y) = kInk;
  }
  const int text = text_width(number, layout.scale) - layout.scale;
  const int left = std::clamp(x - text / 2, layout.margin, layout.width - layout.margin - text);
  draw_text(image, left, top + layout.numbers_y, number, layout.scale, kInk);
}

void draw_numbers(Image& image, int top, const BarLayout& layout, const HeatMap& map) {
  const double end = brightest_value(map);
  const bool clipped = largest(map) > brightest_value(map);
  const std::string end_number = fmt::format("{:.6g}{}", end, clipped ? "+" : "");
  const int room = text_width(end_number, layout.scale) + 2 * kGlyphAdvance * layout.scale;
  for (const double tick : legend_ticks(end, std::max(2, layout.bar_width() * 3 / (4 * room)))) {
    const bool free_of_end = (1.0 - tick / end) * layout.bar_width() > 1.5 * room;
    if (free_of_end) draw_number(image, top, layout, tick / end, fmt::format("{:.6g}", tick));
  }
  draw_number(image, top, layout, 1.0, end_number);
}

}  // namespace

int text_width(std::string_view text, int scale) {
  return static_cast<int>(text.size()) * kGlyphAdvance * scale;
}

void draw_text(Image& image, int x, int y, std::string_view text, int scale,
               const glm::vec3& color) {
  for (const char character : text) {
    const std::size_t index = kCharacters.find(character);
    const std::uint64_t glyph = index < kGlyphs.size() ? kGlyphs[index] : kUnknown;
    for (int row = 0; row < kGlyphHeight; ++row) {
      for (int column = 0; column < 5; ++column) {
        const int bit = 8 * (kGlyphHeight - 1 - row) + 4 - column;
        if ((glyph >> bit & 1U) != 0)
          fill(image, x + column * scale, y + row * scale, scale, color);
      }
    }
    x += kGlyphAdvance * scale;
  }
}

LegendLayout::LegendLayout(int picture_width, std::size_t characters) {
  const int dots = static_cast<int>(characters) * kGlyphAdvance + 2 * kLegendMargin;
  scale = std::clamp(picture_width / dots, 1, 2);
  margin = kLegendMargin * scale;
  width = std::max(picture_width, dots * scale);
}

Image above_legend(const Image& picture, const LegendLayout& layout, int height) {
  Image image(layout.width, picture.height() + height, kPaper);
  const int left = (layout.width - picture.width()) / 2;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) image.at(left + x, y) = picture.at(x, y);
  }
  return image;
}

namespace okabe_ito {
const glm::vec3 kSkyBlue = linear_from_srgb(glm::vec3(86, 180, 233) / 255.0F);
const glm::vec3 kYellow = linear_from_srgb(glm::vec3(240, 228, 66) / 255.0F);
const glm::vec3 kBluishGreen = linear_from_srgb(glm::vec3(0, 158, 115) / 255.0F);
const glm::vec3 kVermillion = linear_from_srgb(glm::vec3(213, 94, 0) / 255.0F);
const glm::vec3 kOrange = linear_from_srgb(glm::vec3(230, 159, 0) / 255.0F);
const glm::vec3 kBlue = linear_from_srgb(glm::vec3(0, 114, 178) / 255.0F);
const glm::vec3 kReddishPurple = linear_from_srgb(glm::vec3(204, 121, 167) / 255.0F);
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
    fill(image, layout.margin, y, swatch, entries[i].color);
    draw_text(image, text, y, lines[i], layout.scale, kInk);
  }
  return image;
}

glm::vec3 dimmed(const glm::vec3& color) { return glm::vec3(kDimmed * relative_luminance(color)); }

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

float brightest_value(const HeatMap& map) {
  std::vector<float> sorted;
  for (const float value : map.values) {
    if (value > 0.0F) sorted.push_back(value);
  }
  if (sorted.empty()) return 1.0F;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t zeros = map.values.size() - sorted.size();
  const std::size_t rank = map.values.size() * kBrightestPerMille / 1000;
  return sorted[std::min(rank > zeros ? rank - zeros : 0, sorted.size() - 1)];
}

Image draw_heat_map(const HeatMap& map) {
  Image image(map.width, map.height);
  const float end = brightest_value(map);
  std::ranges::transform(map.values, image.pixels().begin(),
                         [end](float value) { return heat_color(value / end); });
  return image;
}

Image draw_heat_map_with_legend(const HeatMap& map) {
  const double maximum = largest(map);
  const std::string heading =
      fmt::format("{}: mean {:.4g}, maximum {:.6g}", map.title, mean(map), maximum);
  const BarLayout layout(map.width, heading);

  Image image = above_legend(draw_heat_map(map), layout, layout.height);
  draw_text(image, layout.margin, map.height + layout.margin, heading, layout.scale, kInk);
  if (maximum > 0.0) {
    draw_bar(image, map.height, layout);
    draw_numbers(image, map.height, layout, map);
  }
  return image;
}

std::vector<double> legend_ticks(double maximum, int at_most) {
  const double wanted = maximum / std::max(at_most - 1, 1);
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0}) {
    if (factor * power >= wanted * (1.0 - 1e-9)) step = factor * power;
  }
  std::vector<double> ticks;
  for (int i = 0; i * step <= maximum * (1.0 + 1e-9); ++i) ticks.push_back(i * step);
  return ticks;
}

}  // namespace beambench::render

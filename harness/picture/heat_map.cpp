#include "harness/picture/heat_map.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "harness/picture/color_map.hpp"
#include "harness/picture/text.hpp"

namespace beambench {
namespace {

const glm::vec3 kPaper(0.012F);
const glm::vec3 kInk(0.82F);

/// Sizes of a legend in pixels: text as large as the picture's width allows, for reading.
struct LegendLayout {
  LegendLayout(int picture_width, std::string_view heading)
      : scale(std::clamp(picture_width / (text_width(heading, 1) + 2 * kMargin), 1, 3)),
        margin(kMargin * scale),
        width(std::max(picture_width, text_width(heading, scale) + 2 * margin)),
        heading_y(margin),
        bar_y(heading_y + (kGlyphHeight + 4) * scale),
        bar_height(8 * scale),
        numbers_y(bar_y + bar_height + 5 * scale),
        height(numbers_y + kGlyphHeight * scale + margin) {}

  static constexpr int kMargin = 8;

  int scale, margin, width, heading_y, bar_y, bar_height, numbers_y, height;
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

void draw_bar(Image& image, int top, const LegendLayout& layout) {
  for (int x = 0; x < layout.bar_width(); ++x) {
    const float part = static_cast<float>(x) / static_cast<float>(layout.bar_width() - 1);
    for (int y = 0; y < layout.bar_height; ++y) {
      image.at(layout.margin + x, top + layout.bar_y + y) = heat_color(part);
    }
  }
}

void draw_ticks(Image& image, int top, const LegendLayout& layout, double maximum) {
  const int widest = text_width(fmt::format("{:.6g}", maximum), layout.scale);
  const int at_most = std::max(2, layout.bar_width() / (widest + 4 * kGlyphAdvance * layout.scale));
  for (const double tick : legend_ticks(maximum, at_most)) {
    const int x =
        layout.margin + static_cast<int>(std::lround(tick / maximum * (layout.bar_width() - 1)));
    for (int y = 0; y < 3 * layout.scale; ++y) {
      image.at(x, top + layout.bar_y + layout.bar_height + y) = kInk;
    }
    const std::string number = fmt::format("{:.6g}", tick);
    const int text = text_width(number, layout.scale) - layout.scale;
    const int left = std::clamp(x - text / 2, layout.margin, layout.width - layout.margin - text);
    draw_text(image, left, top + layout.numbers_y, number, layout.scale, kInk);
  }
}

}  // namespace

Image draw_heat_map(const HeatMap& map) {
  Image image(map.width, map.height);
  const float maximum = std::max(largest(map), 1e-30F);
  std::size_t index = 0;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) image.at(x, y) = heat_color(map.values[index++] / maximum);
  }
  return image;
}

Image draw_heat_map_with_legend(const HeatMap& map) {
  const double maximum = largest(map);
  const std::string heading =
      fmt::format("{}: mean {:.4g}, maximum {:.6g}", map.title, mean(map), maximum);
  const LegendLayout layout(map.width, heading);

  const Image colors = draw_heat_map(map);
  Image image(layout.width, map.height + layout.height, kPaper);
  const int left = (layout.width - map.width) / 2;
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) image.at(left + x, y) = colors.at(x, y);
  }
  draw_text(image, layout.margin, map.height + layout.heading_y, heading, layout.scale, kInk);
  if (maximum > 0.0) {
    draw_bar(image, map.height, layout);
    draw_ticks(image, map.height, layout, maximum);
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

}  // namespace beambench

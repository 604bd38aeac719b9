#include "harness/render/picture/heat_map.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "harness/render/picture/color.hpp"
#include "harness/render/picture/text.hpp"

namespace beambench::render {
namespace {

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

/// Writes a number under its place on the bar; `part` of the bar is to its left.
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

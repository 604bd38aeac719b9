#pragma once
// Pictures with a legend: numbers or categories as colors, and small text that explains them.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "harness/render/picture/image.hpp"

namespace beambench::render {

inline constexpr int kGlyphHeight = 7;   ///< in dots
inline constexpr int kGlyphAdvance = 6;  ///< five dots and a gap

/// Returns the width in pixels of a string drawn with dots of `scale` x `scale` pixels.
int text_width(std::string_view text, int scale);

/// Draws lower-case letters, digits, blanks and . , : _ - + = ( ) /; anything else is drawn as a
/// box. (x, y) is the top left corner; parts outside the image are clipped.
void draw_text(Image& image, int x, int y, std::string_view text, int scale,
               const glm::vec3& color);

/// Linear light of a legend's text.
inline constexpr glm::vec3 kInk(0.82F);

/// The sizes of a legend in pixels: the text is as large as the picture's width allows, up to two
/// pixels per dot. The picture is widened if it is narrower than its legend.
struct LegendLayout {
  /// `characters` is the length of the longest line.
  LegendLayout(int picture_width, std::size_t characters);

  int scale, margin, width;
};

/// Returns the picture, centered, above `height` empty rows for a legend.
Image above_legend(const Image& picture, const LegendLayout& layout, int height);

/// Colors that people with any kind of color vision can distinguish: those of Okabe and Ito, "Color
/// Universal Design", 2008, without black. Linear light.
namespace okabe_ito {
extern const glm::vec3 kSkyBlue;
extern const glm::vec3 kYellow;
extern const glm::vec3 kBluishGreen;
extern const glm::vec3 kVermillion;
extern const glm::vec3 kOrange;
extern const glm::vec3 kBlue;
extern const glm::vec3 kReddishPurple;
}  // namespace okabe_ito

/// A line of the legend.
struct LegendEntry {
  std::string name;
  glm::vec3 color;  ///< linear light
  std::size_t count;
};

/// Returns the picture above a title and the entries. It is widened if it is narrower than its
/// legend.
Image with_legend(const Image& picture, const std::string& title,
                  std::span<const LegendEntry> entries);

/// Returns dimmed gray, as the background for colors that stand out.
glm::vec3 dimmed(const glm::vec3& color);
void dim(Image& image);

/// The meaning of a color.
struct Category {
  std::string name;
  glm::vec3 color;  ///< linear light
};

/// The category of each pixel, row by row from the top left.
struct CategoryMap {
  static constexpr std::uint8_t kNone = 255;

  std::string title;
  std::vector<Category> categories;
  std::vector<std::uint8_t> pixels;  ///< index into `categories`, or kNone
};

/// Draws the map over `ground`, an image of its size that is shown in dimmed gray, above a legend
/// with the number of pixels of each category. The pixels of a small category are framed so that
/// they are not overlooked. The picture is widened if it is narrower than its legend.
Image draw_category_map(const CategoryMap& map, const Image& ground);

/// Values >= 0, one for each pixel, row by row from the top left.
struct HeatMap {
  std::string title;  ///< the meaning of the values: "traversal_steps per ray"
  int width;
  int height;
  std::vector<float> values;
};

/// Returns the value that gets the brightest color: the 99.5% quantile, so that a few rays with far
/// more work do not darken the others. It is at least the smallest value > 0.
float brightest_value(const HeatMap& map);

/// Draws colors from 0 to the brightest value, without a legend.
Image draw_heat_map(const HeatMap& map);

/// Draws the map above a legend with title, mean, maximum and a bar with numbers. A plus sign after
/// the last number means that larger values share its color. The picture is widened if it is
/// narrower than its legend.
Image draw_heat_map_with_legend(const HeatMap& map);

/// Returns the numbers under a bar from 0 to `maximum` > 0: at most `at_most` multiples of 1, 2 or
/// 5 times a power of ten, starting at 0.
std::vector<double> legend_ticks(double maximum, int at_most);

}  // namespace beambench::render

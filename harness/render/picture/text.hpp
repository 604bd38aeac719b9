#pragma once
// Small text in pictures: enough for a legend, without a font file.

#include <cstddef>
#include <string_view>

#include <glm/vec3.hpp>

#include "harness/render/picture/image.hpp"

namespace beambench::render {

inline constexpr int kGlyphHeight = 7;   ///< in dots
inline constexpr int kGlyphAdvance = 6;  ///< five dots and a gap

/// Width in pixels of a text drawn with dots of `scale` x `scale` pixels.
int text_width(std::string_view text, int scale);

/// Draws lower-case letters, digits, blanks and . , : _ - + = ( ) /; anything else as a box. (x, y)
/// is the top left corner; what leaves the image is cut off.
void draw_text(Image& image, int x, int y, std::string_view text, int scale,
               const glm::vec3& color);

/// Linear light of a legend's text.
inline constexpr glm::vec3 kInk(0.82F);

/// The sizes of a legend in pixels: text as large as the picture's width allows, up to two pixels a
/// dot. The picture is widened where it is narrower than its legend.
struct LegendLayout {
  /// `characters`: of the longest line.
  LegendLayout(int picture_width, std::size_t characters);

  int scale, margin, width;
};

/// The picture in the middle above so many empty rows of a legend.
Image above_legend(const Image& picture, const LegendLayout& layout, int height);

}  // namespace beambench::render

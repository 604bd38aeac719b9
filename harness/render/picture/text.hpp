#pragma once
// Small text in pictures: enough for a legend, without a font file.

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

/// Linear light of a legend's ground and text.
inline constexpr glm::vec3 kPaper(0.012F);
inline constexpr glm::vec3 kInk(0.82F);
inline constexpr int kLegendMargin = 8;  ///< in dots of the text

}  // namespace beambench::render

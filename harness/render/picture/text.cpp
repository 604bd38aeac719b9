#include "harness/render/picture/text.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace beambench::render {
namespace {

constexpr int kLegendMargin = 8;     // in dots of the text
constexpr glm::vec3 kPaper(0.012F);  // linear light of the ground

constexpr std::string_view kCharacters = "0123456789abcdefghijklmnopqrstuvwxyz .,:_-+=()/";
/// Of each character: seven bytes, the rows from the top; in each the five lowest bits, the highest
/// being the leftmost dot.
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

void fill_dot(Image& image, int x0, int y0, int scale, const glm::vec3& color) {
  for (int y = y0; y < y0 + scale; ++y) {
    for (int x = x0; x < x0 + scale; ++x) {
      if (x >= 0 && x < image.width() && y >= 0 && y < image.height()) image.at(x, y) = color;
    }
  }
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
          fill_dot(image, x + column * scale, y + row * scale, scale, color);
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

}  // namespace beambench::render

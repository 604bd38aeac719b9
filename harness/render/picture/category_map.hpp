#pragma once
// Pictures whose colors stand for categories, with a legend.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "harness/render/picture/image.hpp"

namespace beambench::render {

/// Colors that people with any kind of color vision can distinguish: four of Okabe and
/// Ito, "Color Universal Design", 2008. Linear light.
namespace okabe_ito {
extern const glm::vec3 kSkyBlue;
extern const glm::vec3 kYellow;
extern const glm::vec3 kBluishGreen;
extern const glm::vec3 kVermillion;
}  // namespace okabe_ito

/// A line of the legend.
struct LegendEntry {
  std::string name;
  glm::vec3 color;  ///< linear light
  std::size_t count;
};

/// The picture above a title and the entries. It is widened where it is narrower than its legend.
Image with_legend(const Image& picture, const std::string& title,
                  std::span<const LegendEntry> entries);

/// Dimmed gray, for a picture that colors are to stand out from.
glm::vec3 dimmed(const glm::vec3& color);
void dim(Image& image);

/// The meaning of a color.
struct Category {
  std::string name;
  glm::vec3 color;  ///< linear light
};

/// Which category each pixel belongs to, row by row from the top left.
struct CategoryMap {
  static constexpr std::uint8_t kNone = 255;

  std::string title;
  std::vector<Category> categories;
  std::vector<std::uint8_t> pixels;  ///< index into `categories`, or kNone
};

/// The map over `ground`, an image of its size that is shown in dimmed gray, above a legend with
/// the number of pixels of each category. Pixels of a category that has only a few are framed, or
/// they would be overlooked. The picture is widened where it is narrower than its legend.
Image draw_category_map(const CategoryMap& map, const Image& ground);

}  // namespace beambench::render

#pragma once
// A picture of kinds: each pixel is left gray or gets the color of its category, with a legend.

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "harness/render/picture/image.hpp"

namespace beambench::render {

/// What a color says.
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
/// nobody would find them. The picture is widened where it is narrower than its legend.
Image draw_category_map(const CategoryMap& map, const Image& ground);

}  // namespace beambench::render

#pragma once
// A legend that says what the colors of a picture stand for, and how much there is of each.

#include <cstddef>
#include <span>
#include <string>

#include <glm/vec3.hpp>

#include "harness/render/picture/image.hpp"

namespace beambench::render {

/// Colors that people with any kind of color vision tell apart, and from gray: four of Okabe and
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

/// What a picture becomes where colors shall stand out from it: dimmed gray.
glm::vec3 dimmed(const glm::vec3& color);
void dim(Image& image);

}  // namespace beambench::render

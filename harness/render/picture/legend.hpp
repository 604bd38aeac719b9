#pragma once
// What the legends of pictures have in common.

#include <glm/vec3.hpp>

namespace beambench::render {

/// Linear light of a legend's ground and text.
inline constexpr glm::vec3 kPaper(0.012F);
inline constexpr glm::vec3 kInk(0.82F);
inline constexpr int kLegendMargin = 8;  ///< in dots of the text

}  // namespace beambench::render

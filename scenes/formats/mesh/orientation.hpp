#pragma once
// How a mesh stands in its coordinates.

#include <optional>
#include <string_view>

#include <glm/vec3.hpp>

namespace beambench::scenes::mesh {

/// Two axes at right angles: where its top is, and where it faces.
struct Orientation {
  glm::dvec3 up{0.0, 1.0, 0.0};
  glm::dvec3 front{0.0, 0.0, 1.0};
};

/// What is usual in a format: in STL z is up and the front faces -y, in all others y is up and the
/// front faces z.
Orientation usual_orientation(std::string_view ending);

/// `x`, `-x`, `y`, `-y`, `z` or `-z`; nothing for another text.
std::optional<glm::dvec3> parse_axis(std::string_view text);

}  // namespace beambench::scenes::mesh

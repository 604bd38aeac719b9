#include "scenes/formats/mesh/orientation.hpp"

namespace beambench::scenes::mesh {

Orientation usual_orientation(std::string_view ending) {
  if (ending == "stl") return {{0.0, 0.0, 1.0}, {0.0, -1.0, 0.0}};
  return {};
}

std::optional<glm::dvec3> parse_axis(std::string_view text) {
  const double sign = text.starts_with('-') ? -1.0 : 1.0;
  if (sign < 0.0) text.remove_prefix(1);
  if (text == "x") return glm::dvec3(sign, 0.0, 0.0);
  if (text == "y") return glm::dvec3(0.0, sign, 0.0);
  if (text == "z") return glm::dvec3(0.0, 0.0, sign);
  return std::nullopt;
}

}  // namespace beambench::scenes::mesh

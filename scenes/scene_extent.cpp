#include "scenes/scene_extent.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace beambench::scenes {

std::string extent_fault(const Bounds& bounds) {
  if (bounds.empty()) return "";
  const double diagonal = glm::length(glm::dvec3(bounds.upper) - glm::dvec3(bounds.lower));
  if (diagonal >= kMinExtent) return "";
  return fmt::format(
      "the diagonal of its box is {:.3g}, but must be at least {:g}, or products of lengths leave "
      "the range of single precision; scale it up, cameras and lights with it",
      diagonal, kMinExtent);
}

}  // namespace beambench::scenes

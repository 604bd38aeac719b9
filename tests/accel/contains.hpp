#pragma once

#include <glm/glm.hpp>

#include "scenes/bounds.hpp"

namespace beambench::tests {

/// Returns whether all points of the inner box are in the outer one.
inline bool contains(const scenes::Bounds& outer, const scenes::Bounds& inner) {
  return glm::all(glm::lessThanEqual(outer.lower, inner.lower)) &&
         glm::all(glm::lessThanEqual(inner.upper, outer.upper));
}

}  // namespace beambench::tests

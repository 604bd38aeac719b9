#pragma once
// Rotations with the same bits on every machine.

#include <glm/mat4x4.hpp>

namespace beambench {

/// A rotation counter-clockwise about the x (0), y (1) or z (2) axis, seen from its positive end.
/// Use this rather than glm::rotate, whose sine comes from the library.
glm::dmat4 rotation(int axis, double degrees);

}  // namespace beambench

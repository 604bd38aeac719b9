#pragma once
// Rotations that have the same bits on every machine.

#include <glm/mat4x4.hpp>

namespace beambench::scenes::modelling {

/// Counter-clockwise about the x (0), y (1) or z (2) axis, seen from its positive end. Use this
/// rather than glm::rotate, whose sine is the library's.
glm::dmat4 rotation(int axis, double degrees);

}  // namespace beambench::scenes::modelling

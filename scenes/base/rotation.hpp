#pragma once
// Rotations, with the same bits on every machine, and translations.

#include <glm/mat4x4.hpp>

namespace beambench {

/// Returns a rotation about the x (0), y (1) or z (2) axis, counter-clockwise as seen from the
/// axis's positive end. Use this rather than glm::rotate, whose sine comes from the library.
glm::dmat4 rotation(int axis, double degrees);

/// Returns a translation.
glm::dmat4 moved_by(const glm::dvec3& offset);

}  // namespace beambench

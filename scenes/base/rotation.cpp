#include "scenes/base/rotation.hpp"

#include <glm/trigonometric.hpp>
#include <glm/vec4.hpp>

#include "scenes/base/portable_math.hpp"

namespace beambench {

glm::dmat4 rotation(int axis, double degrees) {
  const double cosine = portable_cos(glm::radians(degrees));
  const double sine = portable_sin(glm::radians(degrees));
  const int next = (axis + 1) % 3;
  const int last = (axis + 2) % 3;
  glm::dmat4 matrix(1.0);
  matrix[next][next] = cosine;
  matrix[next][last] = sine;
  matrix[last][next] = -sine;
  matrix[last][last] = cosine;
  return matrix;
}

glm::dmat4 moved_by(const glm::dvec3& offset) {
  glm::dmat4 matrix(1.0);
  matrix[3] = glm::dvec4(offset, 1.0);
  return matrix;
}

}  // namespace beambench

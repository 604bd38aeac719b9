#include "scenes/modelling/rotation.hpp"

#include <glm/trigonometric.hpp>

#include "scenes/core/portable_math.hpp"

namespace beambench::scenes::modelling {

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

}  // namespace beambench::scenes::modelling

#include "harness/render/picture/image_error.hpp"

#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "harness/render/picture/srgb.hpp"

namespace beambench::render {

double root_mean_square_error(const Image& picture, const Image& reference) {
  double sum = 0.0;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const glm::dvec3 difference = glm::dvec3(srgb_from_linear(picture.at(x, y))) -
                                    glm::dvec3(srgb_from_linear(reference.at(x, y)));
      sum += glm::dot(difference, difference);
    }
  }
  return 255.0 * std::sqrt(sum / (3.0 * picture.width() * picture.height()));
}

}  // namespace beambench::render

#include "harness/render/picture/image.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "harness/rays/fingerprint.hpp"
#include "harness/render/picture/color.hpp"

namespace beambench::render {

void expose(Image& image, double stops) {
  const auto factor = static_cast<float>(std::exp2(stops));
  for (glm::vec3& pixel : image.pixels()) pixel *= factor;
}

Overexposure overexposure(const Image& image) {
  std::vector<float> values;
  values.reserve(image.pixels().size());
  for (const glm::vec3& pixel : image.pixels()) values.push_back(brightest(pixel));
  const auto too_bright =
      std::count_if(values.begin(), values.end(), [](float value) { return value > 1.0F; });
  const auto hundredth = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 100);
  std::nth_element(values.begin(), hundredth, values.end(), std::greater<>());
  Overexposure found;
  found.share = static_cast<double>(too_bright) / static_cast<double>(values.size());
  if (*hundredth > 1.0F) found.remedy = std::floor(-10.0 * std::log2(double{*hundredth})) / 10.0;
  return found;
}

std::uint64_t fingerprint(const Image& image) {
  const std::span<const glm::vec3> pixels = image.pixels();
  return rays::fingerprint(
      std::string_view(reinterpret_cast<const char*>(pixels.data()),  // NOLINT: bytes
                       pixels.size_bytes()));
}

double root_mean_square_error(const Image& picture, const Image& reference) {
  double sum = 0.0;
  for (std::size_t i = 0; i < picture.pixels().size(); ++i) {
    const glm::dvec3 difference = glm::dvec3(srgb_from_linear(picture.pixels()[i])) -
                                  glm::dvec3(srgb_from_linear(reference.pixels()[i]));
    sum += glm::dot(difference, difference);
  }
  return 255.0 * std::sqrt(sum / (3.0 * picture.width() * picture.height()));
}

}  // namespace beambench::render

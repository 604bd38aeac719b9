#include "harness/render/picture/color.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>

namespace beambench::render {
namespace {

constexpr float kDegree = std::numbers::pi_v<float> / 180.0F;

float cube(float x) { return x * x * x; }
float fourth(float x) { return x * x * x * x; }
float fraction(double x) { return static_cast<float>(x - std::floor(x)); }

}  // namespace

glm::vec3 linear_from_oklch(float lightness, float chroma, float hue) {
  const float a = chroma * std::cos(hue);
  const float b = chroma * std::sin(hue);
  const float l = cube(lightness + 0.3963377774F * a + 0.2158037573F * b);
  const float m = cube(lightness - 0.1055613458F * a - 0.0638541728F * b);
  const float s = cube(lightness - 0.0894841775F * a - 1.2914855480F * b);
  return {4.0767416621F * l - 3.3077115913F * m + 0.2309699292F * s,
          -1.2684380046F * l + 2.6097574011F * m - 0.3413193965F * s,
          -0.0041960863F * l - 0.7034186147F * m + 1.7076147010F * s};
}

glm::vec3 heat_color(float x) {
  x = std::clamp(x, 0.0F, 1.0F);
  const float lightness = 0.22F + 0.70F * x;
  // Below sRGB's maximum for each lightness and hue on the path, which is smallest at the teal.
  const float chroma = 0.08F + 0.03F * fourth(1.0F - x) + 0.10F * fourth(x);
  const float hue = (290.0F - 185.0F * x) * kDegree;
  return glm::clamp(linear_from_oklch(lightness, chroma, hue), 0.0F, 1.0F);
}

glm::vec3 id_color(std::uint32_t id) {
  // Multiples of the golden ratio, modulo 1, are far apart (Knuth, TAOCP 3, 6.4).
  const double n = id;
  const float hue = 2.0F * std::numbers::pi_v<float> * fraction(n * (std::numbers::phi - 1.0));
  const float lightness = 0.55F + 0.27F * fraction(n * (std::numbers::sqrt2 - 1.0));
  return glm::clamp(linear_from_oklch(lightness, 0.12F, hue), 0.0F, 1.0F);
}

}  // namespace beambench::render

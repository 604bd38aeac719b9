#include "harness/render/picture/tone.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "harness/render/picture/color.hpp"

namespace beambench::render {
namespace {

// Reinhard et al. use keys from 0.09 for dark subjects to 0.36 for bright ones, half and twice the
// usual 0.18.
constexpr double kLowKey = 0.09;
constexpr double kHighKey = 0.36;

/// Returns the luminance with the primaries of sRGB (ITU-R BT.709).
double luminance(const glm::vec3& color) {
  return glm::dot(glm::dvec3(color), glm::dvec3(0.2126, 0.7152, 0.0722));
}

bool is_lit(const glm::vec3& color) {
  return std::isfinite(color.x) && std::isfinite(color.y) && std::isfinite(color.z) &&
         brightest(color) > 0.0F && luminance(color) > 0.0;
}

/// Returns the value that at most 1% of the values exceed. There must be at least one value.
double hundredth(std::vector<float> values) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 100);
  std::nth_element(values.begin(), place, values.end(), std::greater<>());
  return *place;
}

double exposure_for(double mean, double bright) {
  if (mean < kLowKey) return kLowKey / mean;
  return std::clamp(kHighKey / mean, std::min(1.0, ToneCurve::kPeak / bright), 1.0);
}

}  // namespace

ToneCurve::ToneCurve(double exposure, double white) : exposure_(exposure), white_(white) {
  if (!(exposure > 0.0) || !(white >= kPeak)) throw std::invalid_argument("no tone curve");
}

double ToneCurve::stops() const { return std::log2(exposure_); }

double ToneCurve::operator()(double brightest) const {
  const double light = exposure_ * brightest;
  if (white_ == kPeak) return std::min(light, 1.0);
  // In units of kPeak; white_ / kPeak is the paper's white.
  const double shown = light * (1.0 + light * kPeak / (white_ * white_)) / (1.0 + light / kPeak);
  return std::min(shown, 1.0);
}

ToneCurve choose_tone(const Image& image) {
  std::vector<float> values;
  double logarithms = 0.0;
  for (const glm::vec3& pixel : image.pixels()) {
    if (!is_lit(pixel)) continue;
    values.push_back(brightest(pixel));
    logarithms += std::log(luminance(pixel));
  }
  if (values.empty()) return ToneCurve();
  const double mean = std::exp(logarithms / static_cast<double>(values.size()));
  const double bright = hundredth(std::move(values));
  const double exposure = exposure_for(mean, bright);
  return ToneCurve(exposure, std::max(exposure * bright, ToneCurve::kPeak));
}

void apply(Image& image, const ToneCurve& curve) {
  for (glm::vec3& pixel : image.pixels()) {
    if (!is_lit(pixel)) continue;
    const double light = brightest(pixel);
    pixel = glm::vec3(glm::dvec3(pixel) * (curve(light) / light));
  }
}

}  // namespace beambench::render

#include "scenes/modelling/profile.hpp"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "scenes/core/portable_math.hpp"

namespace beambench::scenes::modelling {

Profile& Profile::line(const glm::dvec2& to) {
  points_.push_back(to);
  return *this;
}

Profile& Profile::curve(const glm::dvec2& to, double bulge, int steps) {
  const glm::dvec2 from = points_.back();
  const glm::dvec2 way = glm::normalize(to - from);
  const glm::dvec2 control = 0.5 * (from + to) + 2.0 * bulge * glm::dvec2(way.y, -way.x);
  for (int i = 1; i < steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    points_.push_back((1.0 - t) * (1.0 - t) * from + 2.0 * t * (1.0 - t) * control + t * t * to);
  }
  return line(to);
}

Profile& Profile::ball(double center, double radius, int steps) {
  // The step whose radius comes first to that of the present point, then equal angles to the top.
  const double share = points_.back().x / radius;
  double start = 0.5 * std::numbers::pi;
  for (double half = 0.25 * std::numbers::pi; half > 1e-12; half *= 0.5) {
    start += portable_cos(start - 0.5 * std::numbers::pi) > share ? half : -half;
  }
  for (int i = 0; i < steps; ++i) {
    const double angle = std::lerp(start, 0.0, static_cast<double>(i) / steps);
    const glm::dvec2 place(radius * portable_sin(angle), center + radius * portable_cos(angle));
    if (glm::length(place - points_.back()) > 1e-6 * radius) points_.push_back(place);
  }
  return line({0.0, center + radius});
}

}  // namespace beambench::scenes::modelling

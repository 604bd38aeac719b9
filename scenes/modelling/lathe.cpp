#include "scenes/modelling/lathe.hpp"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "scenes/base/portable_math.hpp"

namespace beambench::scenes::modelling {

Profile& Profile::line(const glm::dvec2& to) {
  points_.push_back(to);
  return *this;
}

Profile& Profile::curve(const glm::dvec2& to, double bulge, int steps) {
  const glm::dvec2 from = points_.back();
  const glm::dvec2 direction = glm::normalize(to - from);
  const glm::dvec2 control =
      0.5 * (from + to) + 2.0 * bulge * glm::dvec2(direction.y, -direction.x);
  for (int i = 1; i < steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    points_.push_back((1.0 - t) * (1.0 - t) * from + 2.0 * t * (1.0 - t) * control + t * t * to);
  }
  return line(to);
}

Profile& Profile::ball(double center, double radius, int steps) {
  // Finds the angle at which the ball has the current point's radius, then takes equal steps to the
  // top.
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

PolygonMesh lathe(std::span<const glm::dvec2> profile, int sides, double first_turn) {
  PolygonMesh mesh;
  std::vector<std::uint32_t> first;  // by profile point: its ring's first vertex
  for (const glm::dvec2& point : profile) {
    first.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    const int copies = point.x == 0.0 ? 1 : sides;
    for (int i = 0; i < copies; ++i) {
      const double angle = 2.0 * std::numbers::pi * (first_turn + static_cast<double>(i) / sides);
      mesh.vertices.emplace_back(point.x * portable_cos(angle), point.x * portable_sin(angle),
                                 point.y);
    }
  }
  const auto steps = static_cast<std::uint32_t>(sides);
  for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
    const bool bottom_pole = profile[k].x == 0.0;
    const bool top_pole = profile[k + 1].x == 0.0;
    if (bottom_pole && top_pole) continue;
    for (std::uint32_t i = 0; i < steps; ++i) {
      const std::uint32_t next = (i + 1) % steps;
      PolygonMesh::Corners corners;
      corners.push_back(first[k] + (bottom_pole ? 0 : i));
      if (!bottom_pole) corners.push_back(first[k] + next);
      corners.push_back(first[k + 1] + (top_pole ? 0 : next));
      if (!top_pole) corners.push_back(first[k + 1] + i);
      mesh.polygons.push_back(corners);
    }
  }
  return mesh;
}

}  // namespace beambench::scenes::modelling

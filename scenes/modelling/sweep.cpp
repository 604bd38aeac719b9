#include "scenes/modelling/sweep.hpp"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "scenes/base/portable_math.hpp"

namespace beambench::scenes::modelling {
namespace {

glm::dvec3 direction_at(std::span<const glm::dvec3> path, std::size_t i) {
  const std::size_t before = i == 0 ? 0 : i - 1;
  const std::size_t after = i + 1 == path.size() ? i : i + 1;
  return glm::normalize(path[after] - path[before]);
}

glm::dvec3 reflected(const glm::dvec3& vector, const glm::dvec3& mirror) {
  return vector - mirror * (2.0 * glm::dot(mirror, vector) / glm::dot(mirror, mirror));
}

/// Returns the frame's side at the next point: `side`, reflected first along the step and then
/// along the change of direction.
glm::dvec3 carried(const glm::dvec3& side, const glm::dvec3& step, const glm::dvec3& from,
                   const glm::dvec3& to) {
  const glm::dvec3 turn = to - reflected(from, step);
  const glm::dvec3 once = reflected(side, step);
  return glm::dot(turn, turn) < 1e-24 ? once : reflected(once, turn);
}

}  // namespace

std::vector<glm::dvec2> circle(int sides) {
  std::vector<glm::dvec2> points;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    points.emplace_back(portable_cos(angle), portable_sin(angle));
  }
  return points;
}

PolygonMesh sweep(std::span<const glm::dvec2> outline, std::span<const glm::dvec3> path,
                  std::span<const double> scales, const glm::dvec3& side, Caps caps) {
  PolygonMesh mesh;
  std::vector<std::uint32_t> first;
  glm::dvec3 direction = direction_at(path, 0);
  glm::dvec3 x = glm::normalize(side - direction * glm::dot(side, direction));
  for (std::size_t k = 0; k < path.size(); ++k) {
    if (k > 0) {
      const glm::dvec3 next = direction_at(path, k);
      x = carried(x, path[k] - path[k - 1], direction, next);
      direction = next;
    }
    const glm::dvec3 y = glm::cross(direction, x);
    first.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    if (scales[k] == 0.0) {
      mesh.vertices.push_back(path[k]);
      continue;
    }
    for (const glm::dvec2& point : outline) {
      mesh.vertices.push_back(path[k] + scales[k] * (point.x * x + point.y * y));
    }
  }
  const auto sides = static_cast<std::uint32_t>(outline.size());
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    const bool starts = scales[k] == 0.0;
    const bool ends = scales[k + 1] == 0.0;
    if (starts && ends) continue;
    for (std::uint32_t i = 0; i < sides; ++i) {
      const std::uint32_t next = (i + 1) % sides;
      PolygonMesh::Corners corners;
      corners.push_back(first[k] + (starts ? 0 : i));
      if (!starts) corners.push_back(first[k] + next);
      corners.push_back(first[k + 1] + (ends ? 0 : next));
      if (!ends) corners.push_back(first[k + 1] + i);
      mesh.polygons.push_back(corners);
    }
  }
  PolygonMesh::Corners cap(sides);
  if (scales.front() != 0.0 && (caps == Caps::kStart || caps == Caps::kBoth)) {
    for (std::uint32_t i = 0; i < sides; ++i) cap[i] = first.front() + sides - 1 - i;
    mesh.polygons.push_back(cap);
  }
  if (scales.back() != 0.0 && (caps == Caps::kEnd || caps == Caps::kBoth)) {
    for (std::uint32_t i = 0; i < sides; ++i) cap[i] = first.back() + i;
    mesh.polygons.push_back(cap);
  }
  return mesh;
}

PolygonMesh tube(std::span<const glm::dvec3> path, std::span<const double> radii, int sides,
                 Caps caps) {
  const glm::dvec3 direction = direction_at(path, 0);
  const glm::dvec3 away =
      std::abs(direction.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
  return sweep(circle(sides), path, radii, glm::cross(away, direction), caps);
}

std::vector<glm::dvec3> spline(std::span<const glm::dvec3> knots, int steps) {
  std::vector<glm::dvec3> points;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const glm::dvec3& b = knots[k];
    const glm::dvec3& c = knots[k + 1];
    const glm::dvec3 a = k == 0 ? 2.0 * b - c : knots[k - 1];
    const glm::dvec3 d = k + 2 == knots.size() ? 2.0 * c - b : knots[k + 2];
    for (int i = 0; i < steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      points.push_back(b + 0.5 * t *
                               ((c - a) + t * ((2.0 * a - 5.0 * b + 4.0 * c - d) +
                                               t * (3.0 * (b - c) + d - a))));
    }
  }
  points.push_back(knots.back());
  return points;
}

}  // namespace beambench::scenes::modelling

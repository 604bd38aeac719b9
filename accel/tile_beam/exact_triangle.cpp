#include "accel/tile_beam/exact_triangle.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace beambench {
namespace {

/// The largest value of a line over a tile's samples.
double largest(const glm::dvec3& line, const TileView& view) {
  return line.z + std::max(0.0, line.x * (view.width - 1)) +
         std::max(0.0, line.y * (view.height - 1));
}

TileLine rounded(const glm::dvec3& line) {
  return {static_cast<float>(line.x), static_cast<float>(line.y), static_cast<float>(line.z)};
}

/// The samples in the triangle's box on the screen, where all of it is before the eye.
std::optional<SampleRectangle> box_of(const TileView& view, const std::array<glm::dvec3, 3>& seen) {
  double left = 0.0;
  double top = 0.0;
  double right = view.width - 1;
  double bottom = view.height - 1;
  if (std::min({seen[0].z, seen[1].z, seen[2].z}) > 0.0) {
    constexpr double kSlack = 0x1p-7;  // of a sample: more than edges are widened by
    std::array<double, 3> x{};
    std::array<double, 3> y{};
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = seen[i].x / seen[i].z;
      y[i] = seen[i].y / seen[i].z;
    }
    left = std::max(left, std::ceil(std::ranges::min(x) - kSlack));
    top = std::max(top, std::ceil(std::ranges::min(y) - kSlack));
    right = std::min(right, std::floor(std::ranges::max(x) + kSlack));
    bottom = std::min(bottom, std::floor(std::ranges::max(y) + kSlack));
  }
  if (left > right || top > bottom) return std::nullopt;
  const auto small = [](double value) { return static_cast<std::uint8_t>(value); };
  return SampleRectangle{small(left), small(right), small(top), small(bottom)};
}

}  // namespace

std::optional<ExactTriangle> exact_triangle(const TileView& view,
                                            const std::array<glm::vec3, 3>& corners) {
  std::array<glm::dvec3, 3> seen;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 corner = glm::dvec3(corners[i]) - glm::dvec3(view.eye);
    seen[i] = {glm::dot(view.exact_x, corner), glm::dot(view.exact_y, corner),
               glm::dot(view.exact_depth, corner)};
  }
  if (std::max({seen[0].z, seen[1].z, seen[2].z}) <= 0.0) return std::nullopt;
  const auto box = box_of(view, seen);
  if (!box) return std::nullopt;

  const double volume = glm::dot(seen[0], glm::cross(seen[1], seen[2]));
  if (volume == 0.0) return std::nullopt;  // the eye is in its plane: rays in it miss
  const double inward = volume > 0.0 ? 1.0 : -1.0;
  ExactTriangle triangle{};
  triangle.box = *box;
  for (std::size_t i = 0; i < 3; ++i) {
    glm::dvec3 edge = glm::cross(seen[i], seen[(i + 1) % 3]) * inward;
    // In samples from the edge; of an edge that lies at infinity only the sign matters.
    const double slope = std::max(std::hypot(edge.x, edge.y), std::abs(edge.z) * 1e-12);
    if (slope == 0.0) return std::nullopt;
    edge /= slope;
    edge.z += kEdgeWidening * std::hypot(edge.x * view.per_angle_x, edge.y * view.per_angle_y);
    if (largest(edge, view) < 0.0) return std::nullopt;
    triangle.edges[i] = rounded(edge);
  }
  const glm::dvec3 plane = glm::cross(seen[1] - seen[0], seen[2] - seen[0]) / volume;
  if (largest(plane, view) <= 0.0) return std::nullopt;
  if (!(glm::length(plane) < 1e30)) return std::nullopt;
  triangle.plane = rounded(plane);
  return triangle;
}

}  // namespace beambench

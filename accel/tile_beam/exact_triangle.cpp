#include "accel/tile_beam/exact_triangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "accel/core/intersect_triangle.hpp"

namespace beambench::accel::tile_beam {
namespace {

/// Returns the largest value of a line over a tile's samples.
double largest(const glm::dvec3& line, const TileView& view) {
  return line.z + std::max(0.0, line.x * (view.width - 1)) +
         std::max(0.0, line.y * (view.height - 1));
}

TileLine rounded(const glm::dvec3& line) {
  return {static_cast<float>(line.x), static_cast<float>(line.y), static_cast<float>(line.z)};
}

/// The range of a triangle along one axis of the screen.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void include(double place) {
    low = std::min(low, place);
    high = std::max(high, place);
  }
};

/// Returns the range of the part of a triangle in front of the eye. Coordinate `axis` of each
/// corner is its place on the screen times its depth. An edge that continues behind the eye leaves
/// the screen at one of its ends.
Range range_of(const std::array<glm::dvec3, 3>& projected, int axis) {
  Range range;
  for (std::size_t i = 0; i < 3; ++i) {
    if (projected[i].z <= 0.0) continue;
    range.include(projected[i][axis] / projected[i].z);
    for (const std::size_t other : {(i + 1) % 3, (i + 2) % 3}) {
      if (projected[other].z > 0.0) continue;
      const double direction =
          projected[other][axis] * projected[i].z - projected[i][axis] * projected[other].z;
      if (direction != 0.0)
        range.include(std::copysign(std::numeric_limits<double>::infinity(), direction));
    }
  }
  return range;
}

/// Returns the samples that the triangle may cover. The box cuts off acute corners, because edges
/// moved outward meet only far beyond them.
std::optional<SampleRectangle> box_of(const TileView& view,
                                      const std::array<glm::dvec3, 3>& projected) {
  const auto clipped = [&](int axis, double per_angle, int samples) {
    const double slack = 1.25 * kEdgeWidening * per_angle;
    const Range range = range_of(projected, axis);
    return Range{std::max(0.0, std::ceil(range.low - slack)),
                 std::min(samples - 1.0, std::floor(range.high + slack))};
  };
  const Range x = clipped(0, view.per_angle_x, view.width);
  const Range y = clipped(1, view.per_angle_y, view.height);
  if (x.low > x.high || y.low > y.high) return std::nullopt;
  const auto small = [](double value) { return static_cast<std::uint8_t>(value); };
  return SampleRectangle{small(x.low), small(x.high), small(y.low), small(y.high)};
}

/// The position of the eye relative to a triangle, to within the error of the canonical test.
enum class Eye { kOff, kInPlane, kOnTriangle };

Eye place_of_eye(const std::array<glm::dvec3, 3>& from_eye) {
  const glm::dvec3 normal = glm::cross(from_eye[1] - from_eye[0], from_eye[2] - from_eye[0]);
  double reach_squared = 0.0;
  for (const glm::dvec3& corner : from_eye) {
    reach_squared = std::max(reach_squared, glm::dot(corner, corner));
  }
  const double height = glm::dot(normal, from_eye[0]);
  if (height * height > kHitSlack * kHitSlack * reach_squared * glm::dot(normal, normal)) {
    return Eye::kOff;
  }
  const bool on = near_triangle(glm::dvec3(0.0), from_eye, normal, std::sqrt(reach_squared));
  return on ? Eye::kOnTriangle : Eye::kInPlane;
}

/// The magnitude of a plane's coefficients, in units of the largest t of its triangle, beyond which
/// rounding may move a hit farther from the triangle than the tolerance for equal hits along a ray.
constexpr double kMinAngle = 0x1p11;

/// The outward shift of edges seen from an apex, relative to their coefficients; the error of edges
/// in float is smaller.
constexpr double kApexWidening = 2e-7;

ExactTriangle left_to_rays(const SampleRectangle& box) { return {{}, {}, box, true}; }

SampleRectangle whole(const TileView& view) {
  return {0, static_cast<std::uint8_t>(view.width - 1), 0,
          static_cast<std::uint8_t>(view.height - 1)};
}

}  // namespace

std::optional<ExactTriangle> exact_triangle(const TileView& view,
                                            const std::array<glm::vec3, 3>& corners) {
  std::array<glm::dvec3, 3> from_eye;
  std::array<glm::dvec3, 3> projected;
  for (std::size_t i = 0; i < 3; ++i) {
    from_eye[i] = glm::dvec3(corners[i]) - glm::dvec3(view.eye);
    projected[i] = {glm::dot(view.exact_x, from_eye[i]), glm::dot(view.exact_y, from_eye[i]),
                    glm::dot(view.exact_depth, from_eye[i])};
  }
  switch (place_of_eye(from_eye)) {
    case Eye::kOnTriangle:
      return left_to_rays(whole(view));
    case Eye::kInPlane:  // rays in its plane miss
      return std::nullopt;
    case Eye::kOff:
      break;
  }
  if (std::max({projected[0].z, projected[1].z, projected[2].z}) <= 0.0) return std::nullopt;
  const auto box = box_of(view, projected);
  if (!box) return std::nullopt;

  const double volume = glm::dot(projected[0], glm::cross(projected[1], projected[2]));
  if (volume == 0.0) return std::nullopt;
  const double inward = volume > 0.0 ? 1.0 : -1.0;
  ExactTriangle triangle{};
  triangle.box = *box;
  for (std::size_t i = 0; i < 3; ++i) {
    glm::dvec3 edge = glm::cross(projected[i], projected[(i + 1) % 3]) * inward;
    // In samples from the edge; for an edge at infinity, only the sign matters.
    const double slope = std::max(std::hypot(edge.x, edge.y), std::abs(edge.z) * 1e-12);
    if (slope == 0.0) return std::nullopt;
    edge /= slope;
    edge.z += kEdgeWidening * std::hypot(edge.x * view.per_angle_x, edge.y * view.per_angle_y);
    if (largest(edge, view) < 0.0) return std::nullopt;
    triangle.edges[i] = rounded(edge);
  }
  const glm::dvec3 plane =
      glm::cross(projected[1] - projected[0], projected[2] - projected[0]) / volume;
  if (largest(plane, view) <= 0.0) return std::nullopt;
  if (!(glm::length(plane) < kNearestOfAll)) return left_to_rays(*box);
  // Seen nearly edge-on, the distance of the triangle at a place in float is very inaccurate.
  const double size =
      std::abs(plane.x) * view.width + std::abs(plane.y) * view.height + std::abs(plane.z);
  const double farthest = std::max({projected[0].z, projected[1].z, projected[2].z});
  if (size * farthest > kMinAngle) return left_to_rays(*box);
  triangle.plane = rounded(plane);
  return triangle;
}

std::optional<ExactApexTriangle> exact_apex_triangle(const glm::vec3& apex, const CubeSide& side,
                                                     const std::array<glm::vec3, 3>& corners) {
  std::array<glm::dvec3, 3> from_apex;
  std::array<glm::dvec3, 3> projected;
  for (std::size_t i = 0; i < 3; ++i) {
    from_apex[i] = glm::dvec3(corners[i]) - glm::dvec3(apex);
    const auto along = [&](std::size_t axis) { return from_apex[i][static_cast<int>(axis)]; };
    projected[i] = {along(side.x_axis()), along(side.y_axis()),
                    along(side.z_axis()) * double{side.sign()}};
  }
  switch (place_of_eye(from_apex)) {
    case Eye::kOnTriangle:
      return ExactApexTriangle{{}, {}, {}, {}, {}, 0.0, 0.0, true};
    case Eye::kInPlane:  // rays in its plane miss
      return std::nullopt;
    case Eye::kOff:
      break;
  }
  if (std::max({projected[0].z, projected[1].z, projected[2].z}) <= 0.0) return std::nullopt;
  const double volume = glm::dot(projected[0], glm::cross(projected[1], projected[2]));
  if (volume == 0.0) return std::nullopt;
  const double inward = volume > 0.0 ? 1.0 : -1.0;
  ExactApexTriangle triangle{};
  for (int axis = 0; axis < 2; ++axis) {
    const Range range = range_of(projected, axis);
    triangle.low[axis] = range.low - 2.0 * kApexWidening;
    triangle.high[axis] = range.high + 2.0 * kApexWidening;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    glm::dvec3 edge = glm::cross(projected[i], projected[(i + 1) % 3]) * inward;
    const double largest = std::max({std::abs(edge.x), std::abs(edge.y), std::abs(edge.z)});
    if (largest == 0.0) return std::nullopt;
    edge /= largest;
    const double widening =
        kApexWidening * (std::abs(edge.x) + std::abs(edge.y) + std::abs(edge.z));
    edge.z += widening;
    triangle.edges[i] = edge;
    triangle.clear[i] = 2.0 * widening;
  }
  const glm::dvec3 plane =
      glm::cross(projected[1] - projected[0], projected[2] - projected[0]) * inward;
  const double largest = std::max({std::abs(plane.x), std::abs(plane.y), std::abs(plane.z)});
  triangle.plane = plane / largest;
  triangle.distance = std::abs(volume) / largest;
  triangle.distance_to_plane = std::abs(volume) / glm::length(plane);
  return triangle;
}

TrianglePlane::TrianglePlane(const std::array<glm::vec3, 3>& corners)
    : first_(corners[0]),
      normal_(glm::cross(glm::dvec3(corners[1]) - first_, glm::dvec3(corners[2]) - first_)) {}

float TrianglePlane::hit(const Ray& ray) const {
  const double along = glm::dot(normal_, glm::dvec3(ray.direction));
  if (along == 0.0) return kMiss;
  const double t = glm::dot(normal_, first_ - glm::dvec3(ray.origin)) / along;
  return accept(t, ray.t_min, finite(ray.t_max));
}

}  // namespace beambench::accel::tile_beam

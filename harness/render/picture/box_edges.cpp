#include "harness/render/picture/box_edges.hpp"

#include <algorithm>
#include <cstddef>

namespace beambench::render {
namespace {

/// How near to the eye's plane an edge is followed, as a part of its farther end's depth. There
/// every point appears at infinity.
constexpr double kNearest = 1e-6;

bool in_front(const accel::Box& box, const glm::dvec3& eye, int axis, bool upper) {
  return upper ? eye[axis] > box.upper[axis] : eye[axis] < box.lower[axis];
}

}  // namespace

bool holds(const accel::Box& box, const glm::dvec3& eye) {
  for (int axis = 0; axis < 3; ++axis) {
    if (eye[axis] < box.lower[axis] || eye[axis] > box.upper[axis]) return false;
  }
  return true;
}

std::array<BoxEdge, 12> box_edges(const accel::Box& box, const glm::dvec3& eye) {
  const bool inside = holds(box, eye);
  std::array<BoxEdge, 12> edges{};
  std::size_t next = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int second = (axis + 1) % 3;
    const int third = (axis + 2) % 3;
    for (int corner = 0; corner < 4; ++corner) {
      const bool second_upper = (corner & 1) != 0;
      const bool third_upper = (corner & 2) != 0;
      BoxEdge& edge = edges[next++];
      edge.from[axis] = box.lower[axis];
      edge.to[axis] = box.upper[axis];
      edge.from[second] = edge.to[second] = (second_upper ? box.upper : box.lower)[second];
      edge.from[third] = edge.to[third] = (third_upper ? box.upper : box.lower)[third];
      edge.turned_to_eye = inside || in_front(box, eye, second, second_upper) ||
                           in_front(box, eye, third, third_upper);
    }
  }
  return edges;
}

std::optional<SeenEdge> project(const BoxEdge& edge, const Projection& projection) {
  const double from_depth = projection.depth(edge.from);
  const double to_depth = projection.depth(edge.to);
  const double nearest = kNearest * std::max(from_depth, to_depth);
  if (!(nearest > 0.0)) return std::nullopt;
  const auto cut = [&](const glm::dvec3& point, double depth, const glm::dvec3& other,
                       double other_depth) {
    if (depth >= nearest) return point;
    return other + (point - other) * ((other_depth - nearest) / (other_depth - depth));
  };
  const glm::dvec3 from = cut(edge.from, from_depth, edge.to, to_depth);
  const glm::dvec3 to = cut(edge.to, to_depth, edge.from, from_depth);
  return SeenEdge{{projection.place(from), projection.place(to)},
                  std::max(from_depth, nearest),
                  std::max(to_depth, nearest)};
}

}  // namespace beambench::render

#include "harness/render/picture/projected_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace beambench::render {
namespace {

/// How near to the eye's plane an edge is followed, as a part of its farther end's depth. There
/// every point appears at infinity.
constexpr double kNearest = 1e-6;

bool in_front(const accel::Box& box, const glm::dvec3& eye, int axis, bool upper) {
  return upper ? eye[axis] > box.upper[axis] : eye[axis] < box.lower[axis];
}

constexpr double kInfiniteDepth = std::numeric_limits<double>::infinity();
/// Points of a box's own surface come out this near to it, as a part of their depth.
constexpr double kRounding = 1e-6;

/// Where a ray enters a box; infinity where it misses it or starts within.
double enter(const accel::Box& box, const glm::dvec3& eye, const glm::dvec3& direction) {
  double first = 0.0;
  double last = kInfiniteDepth;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.lower[axis] - eye[axis];
    const double high = box.upper[axis] - eye[axis];
    if (direction[axis] == 0.0) {
      if (low > 0.0 || high < 0.0) return kInfiniteDepth;
      continue;
    }
    const double a = low / direction[axis];
    const double b = high / direction[axis];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first <= last && first > 0.0 ? first : kInfiniteDepth;
}

/// The pixels that a box may appear in: around its edges, cut off at the eye's plane. Empty
/// (last < first) where there are none.
struct PixelRange {
  glm::ivec2 first;
  glm::ivec2 last;
};
PixelRange pixels_of(const accel::Box& box, const Projection& projection, int width, int height) {
  glm::dvec2 low(kInfiniteDepth);
  glm::dvec2 high(-kInfiniteDepth);
  for (const BoxEdge& edge : box_edges(box, projection.eye())) {
    const auto seen = project(edge, projection);
    if (!seen) continue;
    low = glm::min(low, glm::min(seen->line.from, seen->line.to));
    high = glm::max(high, glm::max(seen->line.from, seen->line.to));
  }
  // Only pixels whose centers lie between: a box buffer asks nothing else.
  const auto first = [](double x, int size) {
    return static_cast<int>(std::clamp(std::ceil(x - 0.5), 0.0, static_cast<double>(size)));
  };
  const auto last = [](double x, int size) {
    return static_cast<int>(std::clamp(std::floor(x - 0.5), -1.0, static_cast<double>(size - 1)));
  };
  return {{first(low.x, width), first(low.y, height)}, {last(high.x, width), last(high.y, height)}};
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

NearestBoxes::NearestBoxes(const Projection& projection, int width, int height,
                           std::span<const accel::Box> boxes)
    : projection_(projection),
      width_(width),
      height_(height),
      boxes_(boxes),
      nearest_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kNone),
      depths_(nearest_.size(), kInfiniteDepth) {
  for (std::uint32_t box = 0; box < boxes.size(); ++box) add(box);
  for (const double depth : depths_) {
    if (depth == kInfiniteDepth) continue;
    range_.nearest = std::min(range_.nearest, depth);
    range_.farthest = std::max(range_.farthest, depth);
  }
}

void NearestBoxes::add(std::uint32_t box) {
  const PixelRange range = pixels_of(boxes_[box], projection_, width_, height_);
  for (int y = range.first.y; y <= range.last.y; ++y) {
    for (int x = range.first.x; x <= range.last.x; ++x) {
      const glm::dvec3 direction = projection_.direction(glm::dvec2(x, y) + 0.5);
      const double depth = enter(boxes_[box], projection_.eye(), direction);
      const std::size_t index = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                                static_cast<std::size_t>(x);
      if (!(depth < depths_[index])) continue;
      depths_[index] = depth;
      nearest_[index] = box;
    }
  }
}

bool NearestBoxes::hide(int x, int y, const glm::dvec2& place, double depth) const {
  if (hidden_by(at(x, y), place, depth)) return true;
  const glm::dvec2 around = glm::floor(place);
  const bool on_image =
      around.x >= 0.0 && around.y >= 0.0 && around.x < width_ && around.y < height_;
  return on_image &&
         hidden_by(at(static_cast<int>(around.x), static_cast<int>(around.y)), place, depth);
}

bool NearestBoxes::hidden_by(std::uint32_t box, const glm::dvec2& place, double depth) const {
  return box != kNone && enter(boxes_[box], projection_.eye(), projection_.direction(place)) <
                             depth * (1.0 - kRounding);
}

std::uint32_t NearestBoxes::at(int x, int y) const {
  return nearest_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(x)];
}

}  // namespace beambench::render

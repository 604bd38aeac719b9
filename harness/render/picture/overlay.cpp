#include "harness/render/picture/overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "harness/render/picture/projection.hpp"
#include "harness/render/picture/raster.hpp"

namespace beambench::render {
namespace {

constexpr double kThickness = 1.0;

/// The minimum depth to which an edge is followed, relative to the depth of its farther end. At
/// this depth, every point appears at infinity.
constexpr double kNearest = 1e-6;

/// The visible part of an edge on the image: the part in front of the camera.
struct SeenEdge {
  PixelSegment line;
  double from_depth;
  double to_depth;

  /// Returns the depth of the point at `along` in [0, 1] on the line; the inverse of depth is
  /// linear on the image.
  double depth_at(double along) const {
    return 1.0 / ((1.0 - along) / from_depth + along / to_depth);
  }
};

struct BoxEdge {
  glm::dvec3 from;
  glm::dvec3 to;
  bool turned_to_eye;  ///< belongs to a face that the camera is in front of
};

bool in_front(const accel::Box& box, const glm::dvec3& eye, int axis, bool upper) {
  return upper ? eye[axis] > box.upper[axis] : eye[axis] < box.lower[axis];
}

bool holds(const accel::Box& box, const glm::dvec3& eye) {
  for (int axis = 0; axis < 3; ++axis) {
    if (eye[axis] < box.lower[axis] || eye[axis] > box.upper[axis]) return false;
  }
  return true;
}

/// Returns all edges, along x, along y, along z. From an eye within the box, all faces are seen
/// from inside, and none is turned away.
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

/// Clips an edge at the camera's plane; nothing if all of it lies behind.
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

constexpr double kInfiniteDepth = std::numeric_limits<double>::infinity();
/// The maximum relative error of the computed depths of points on a box's own surface.
constexpr double kRounding = 1e-6;

/// Returns where a ray enters a box; infinity if it misses or starts inside.
double enter(const accel::Box& box, const glm::dvec3& eye, const glm::dvec3& direction) {
  double first = 0.0;
  double last = kInfiniteDepth;
  for (int axis = 0; axis < 3; ++axis) {
    if (!clip_to_slab(box.lower[axis] - eye[axis], box.upper[axis] - eye[axis], direction[axis],
                      first, last)) {
      return kInfiniteDepth;
    }
  }
  return first <= last && first > 0.0 ? first : kInfiniteDepth;
}

/// The pixels in which a box may appear: around its edges, clipped at the camera's plane. Empty
/// (last < first) if there are none.
struct PixelBounds {
  glm::ivec2 first;
  glm::ivec2 last;
};
PixelBounds pixels_of(const accel::Box& box, const Projection& projection, int width, int height) {
  glm::dvec2 low(kInfiniteDepth);
  glm::dvec2 high(-kInfiniteDepth);
  for (const BoxEdge& edge : box_edges(box, projection.eye)) {
    const auto seen = project(edge, projection);
    if (!seen) continue;
    low = glm::min(low, glm::min(seen->line.from, seen->line.to));
    high = glm::max(high, glm::max(seen->line.from, seen->line.to));
  }
  // Only pixels whose centers lie in the range: a box buffer needs no others.
  const auto first = [](double x, int size) {
    return static_cast<int>(std::clamp(std::ceil(x - 0.5), 0.0, static_cast<double>(size)));
  };
  const auto last = [](double x, int size) {
    return static_cast<int>(std::clamp(std::floor(x - 0.5), -1.0, static_cast<double>(size - 1)));
  };
  return {{first(low.x, width), first(low.y, height)}, {last(high.x, width), last(high.y, height)}};
}

/// Decides what boxes hide with a box buffer: Catmull's z-buffer (1974), but storing the box, so
/// that depths between pixel centers are known. Boxes around the camera hide nothing.
class NearestBoxes {
 public:
  /// The boxes must outlive this object.
  NearestBoxes(const Projection& projection, int width, int height,
               std::span<const accel::Box> boxes)
      : projection_(projection),
        width_(width),
        height_(height),
        boxes_(boxes),
        nearest_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), kNone),
        depths_(nearest_.size(), kInfiniteDepth) {
    for (std::uint32_t box = 0; box < boxes.size(); ++box) add(box);
  }

  /// Returns whether a point that appears at `place`, at this depth, is behind a box. `x` and `y`
  /// are the pixel that would show it; the result is exact if that pixel or the one around `place`
  /// shows the box.
  bool hide(int x, int y, const glm::dvec2& place, double depth) const {
    if (hidden_by(nearest_[index(x, y)], place, depth)) return true;
    const glm::dvec2 around = glm::floor(place);
    const bool on_image =
        around.x >= 0.0 && around.y >= 0.0 && around.x < width_ && around.y < height_;
    return on_image &&
           hidden_by(nearest_[index(static_cast<int>(around.x), static_cast<int>(around.y))], place,
                     depth);
  }

  /// Returns the smallest and the largest depth of the pixels that see a box.
  std::pair<double, double> range() const {
    std::pair<double, double> range{kInfiniteDepth, 0.0};
    for (const double depth : depths_) {
      if (depth == kInfiniteDepth) continue;
      range = {std::min(range.first, depth), std::max(range.second, depth)};
    }
    return range;
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  void add(std::uint32_t box) {
    const PixelBounds range = pixels_of(boxes_[box], projection_, width_, height_);
    for (int y = range.first.y; y <= range.last.y; ++y) {
      for (int x = range.first.x; x <= range.last.x; ++x) {
        const glm::dvec3 direction = projection_.direction(glm::dvec2(x, y) + 0.5);
        const double depth = enter(boxes_[box], projection_.eye, direction);
        if (!(depth < depths_[index(x, y)])) continue;
        depths_[index(x, y)] = depth;
        nearest_[index(x, y)] = box;
      }
    }
  }
  bool hidden_by(std::uint32_t box, const glm::dvec2& place, double depth) const {
    return box != kNone && enter(boxes_[box], projection_.eye, projection_.direction(place)) <
                               depth * (1.0 - kRounding);
  }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  Projection projection_;
  int width_;
  int height_;
  std::span<const accel::Box> boxes_;
  std::vector<std::uint32_t> nearest_;  ///< kNone if no box is visible
  std::vector<double> depths_;
};

constexpr float kCellTint = 0.15F;

struct Look {
  accel::BeamKind kind;
  const char* name;
  const glm::vec3* color;
};
/// The appearance of the layers, from bottom to top.
constexpr std::array kLooks{
    Look{accel::BeamKind::kLeaving, "leaving", &okabe_ito::kBluishGreen},
    Look{accel::BeamKind::kNonTerminal, "non-terminal", &okabe_ito::kSkyBlue},
    Look{accel::BeamKind::kOccupied, "occupied", &okabe_ito::kYellow}};

/// Returns the area of a polygon (the shoelace formula).
double area(std::span<const glm::dvec2> corners) {
  double twice = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 a = corners[i] - corners[0];
    const glm::dvec2 b = corners[(i + 1) % corners.size()] - corners[0];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * std::abs(twice);
}

void add_outline(LineLayer& layer, const accel::BeamOutline& beam) {
  const float strength = line_strength(std::sqrt(area(beam.corners)));
  for (std::size_t i = 0; i < beam.corners.size(); ++i) {
    layer.add({beam.corners[i], beam.corners[(i + 1) % beam.corners.size()]}, kThickness, strength);
  }
}

/// Tints the area where a beam ends, because edges of continuing beams also run along it and hide
/// its own. Areas where no beam ends stay gray; where two ended, the tint would be twice as strong.
void tint(Image& image, const accel::BeamOutline& beam, const glm::vec3& color) {
  for_each_pixel_in(beam.corners, image.width(), image.height(), [&](int x, int y) {
    image.at(x, y) = glm::mix(image.at(x, y), color, kCellTint);
  });
}

}  // namespace

std::vector<LegendEntry> overlay_cells(Image& image, const accel::PrimaryRays& rays,
                                       std::span<const accel::Box> cells) {
  constexpr double kFarthest = 0.45;  // strength of lines at the farthest cells; 1 at the nearest
  dim(image);
  const Projection projection(rays);
  const NearestBoxes boxes(projection, image.width(), image.height(), cells);
  const auto [nearest, farthest] = boxes.range();
  const auto strength = [&, near = nearest, range = farthest - nearest](double size, double depth) {
    const double far = range > 0.0 ? std::clamp((depth - near) / range, 0.0, 1.0) : 0.0;
    return static_cast<float>(1.0 - far * (1.0 - kFarthest)) *
           line_strength(size * projection.scale() / depth);
  };
  LineLayer layer(image.width(), image.height());
  for (const accel::Box& cell : cells) {
    const double size = glm::length(cell.upper - cell.lower) / std::sqrt(3.0);
    for (const BoxEdge& edge : box_edges(cell, projection.eye)) {
      const auto seen = edge.turned_to_eye ? project(edge, projection) : std::nullopt;
      if (!seen) continue;
      for_each_pixel(seen->line, kThickness, image.width(), image.height(),
                     [&](int x, int y, float coverage, double along) {
                       const double depth = seen->depth_at(along);
                       const glm::dvec2 place =
                           seen->line.from + (seen->line.to - seen->line.from) * along;
                       if (boxes.hide(x, y, place, depth)) return;
                       layer.add(x, y, coverage, strength(size, depth));
                     });
    }
  }
  layer.draw_on(image, Image(image), okabe_ito::kYellow);
  return {{"occupied cells", okabe_ito::kYellow, cells.size()}};
}

std::vector<LegendEntry> overlay_beams(Image& image, std::span<const accel::BeamOutline> beams) {
  dim(image);
  std::vector<LegendEntry> legend;
  std::vector<LineLayer> layers(kLooks.size(), LineLayer(image.width(), image.height()));
  for (std::size_t i = 0; i < kLooks.size(); ++i) {
    const Look& look = kLooks[i];
    legend.push_back({look.name, *look.color, 0});
    for (const accel::BeamOutline& beam : beams) {
      if (beam.kind != look.kind) continue;
      ++legend[i].count;
      add_outline(layers[i], beam);
      if (look.kind != accel::BeamKind::kNonTerminal) tint(image, beam, *look.color);
    }
  }
  const Image ground = image;
  for (std::size_t i = 0; i < kLooks.size(); ++i) {
    layers[i].draw_on(image, ground, *kLooks[i].color);
  }
  std::reverse(legend.begin(), legend.end());
  return legend;
}

}  // namespace beambench::render

#include "harness/render/picture/overlay_cells.hpp"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "harness/render/picture/box_edges.hpp"
#include "harness/render/picture/line.hpp"
#include "harness/render/picture/nearest_boxes.hpp"
#include "harness/render/picture/projection.hpp"

namespace beambench::render {
namespace {

constexpr double kThickness = 1.0;
constexpr double kFarthest = 0.45;  // strength of lines at the farthest cells; 1 at the nearest

/// How strong a line is, by its depth and its cell's size.
class Strength {
 public:
  Strength(const NearestBoxes::Range& depths, double scale) : depths_(depths), scale_(scale) {}

  float operator()(double cell_size, double depth) const {
    const double range = depths_.farthest - depths_.nearest;
    const double far = range > 0.0 ? std::clamp((depth - depths_.nearest) / range, 0.0, 1.0) : 0.0;
    return static_cast<float>(1.0 - far * (1.0 - kFarthest)) *
           line_strength(cell_size * scale_ / depth);
  }

 private:
  NearestBoxes::Range depths_;
  double scale_;
};

void add_edge(LineLayer& layer, const SeenEdge& edge, double cell_size, const NearestBoxes& nearest,
              const Strength& strength) {
  for_each_pixel(edge.line, kThickness, layer.width(), layer.height(),
                 [&](int x, int y, float coverage, double along) {
                   const double depth = edge.depth_at(along);
                   const glm::dvec2 place =
                       edge.line.from + (edge.line.to - edge.line.from) * along;
                   if (nearest.hide(x, y, place, depth)) return;
                   layer.add(x, y, coverage, strength(cell_size, depth));
                 });
}

}  // namespace

std::vector<LegendEntry> overlay_cells(Image& image, const accel::PrimaryRays& rays,
                                       std::span<const accel::Box> cells) {
  dim(image);
  const Projection projection(rays);
  const NearestBoxes nearest(projection, image.width(), image.height(), cells);
  const Strength strength(nearest.depths(), projection.scale());
  LineLayer layer(image.width(), image.height());
  for (const accel::Box& cell : cells) {
    const double size = glm::length(cell.upper - cell.lower) / std::sqrt(3.0);
    for (const BoxEdge& edge : box_edges(cell, projection.eye())) {
      if (!edge.turned_to_eye) continue;
      const auto seen = project(edge, projection);
      if (seen) add_edge(layer, *seen, size, nearest, strength);
    }
  }
  layer.draw_on(image, Image(image), okabe_ito::kYellow);
  return {{"occupied cells", okabe_ito::kYellow, cells.size()}};
}

}  // namespace beambench::render

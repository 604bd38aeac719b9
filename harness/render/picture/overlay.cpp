#include "harness/render/picture/overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "harness/render/picture/projected_boxes.hpp"
#include "harness/render/picture/raster.hpp"

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

constexpr float kTint = 0.15F;

struct Look {
  accel::BeamKind kind;
  const char* name;
  const glm::vec3* color;
};
/// From the lowest to the uppermost.
constexpr std::array kLooks{
    Look{accel::BeamKind::kLeaving, "leaving", &okabe_ito::kBluishGreen},
    Look{accel::BeamKind::kNonTerminal, "non-terminal", &okabe_ito::kSkyBlue},
    Look{accel::BeamKind::kOccupied, "occupied", &okabe_ito::kYellow}};

/// Of a polygon (the shoelace formula).
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

/// An end tints its area: the edges of beams that go on run along it, too, and hide its own. What
/// no beam ends at stays gray; where two did, the tint would be twice as strong.
void tint(Image& image, const accel::BeamOutline& beam, const glm::vec3& color) {
  for_each_pixel_in(beam.corners, image.width(), image.height(),
                    [&](int x, int y) { image.at(x, y) = glm::mix(image.at(x, y), color, kTint); });
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

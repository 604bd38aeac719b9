#include "harness/render/picture/overlay_beams.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>

#include "harness/render/picture/convex_fill.hpp"
#include "harness/render/picture/line.hpp"

namespace beambench::render {
namespace {

constexpr double kThickness = 1.0;
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

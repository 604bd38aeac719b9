#include "accel/beam/beam.hpp"

namespace beambench::accel::beam {
namespace {

/// The distance by which a clipped outline extends beyond the line, so that a sample on the line
/// itself, which rounding may put on either side of the outline's edge, stays covered. It is far
/// less than the width of a sliver.
constexpr double kOverlap = 0x1p-43;

void keep_near(std::span<const BeamCut> cuts, Beam& beam) {
  for (const BeamCut& each : cuts) {
    for (const glm::dvec2& corner : beam.outline) {
      if (each.line.at(corner) < -kSliver - each.line.band) continue;
      beam.cuts.push_back(each);
      break;
    }
  }
}

}  // namespace

Beam part_of(const Beam& beam, std::span<const BeamCut> cuts) {
  Beam part;
  part.node = beam.node;
  part.size = beam.size;
  part.corner = beam.corner;
  part.outline = beam.outline;
  for (const BeamCut& each : cuts) {
    part.outline = clip(part.outline, each.line, kOverlap);
    if (part.outline.empty()) return part;
  }
  keep_near({beam.cuts.begin(), beam.cuts.size()}, part);
  keep_near(cuts, part);
  return part;
}

}  // namespace beambench::accel::beam

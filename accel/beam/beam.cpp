#include "accel/beam/beam.hpp"

namespace beambench {
namespace {

/// A clipped outline keeps this much beyond the line: a sample on the line itself, which rounding
/// may put on either side of the outline's edge, stays covered. Far less than a sliver.
constexpr double kOverlap = 0x1p-43;

}  // namespace

void cut(Beam& beam, const Crossing& inner, const Crossing& outer, const ImageLine& line) {
  beam.outline = clip(beam.outline, line, kOverlap);
  beam.cuts.push_back({inner, outer, line});
}

void drop_needless_cuts(Beam& beam) {
  std::size_t kept = 0;
  for (const BeamCut& each : beam.cuts) {
    if (range_over(beam.outline, each.line).high >= -kSliver) beam.cuts[kept++] = each;
  }
  beam.cuts.resize(kept);
}

}  // namespace beambench

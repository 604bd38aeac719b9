#include "accel/beam/beam_cost.hpp"

#include <algorithm>

#include "accel/beam/beam_paths.hpp"

namespace beambench {

void count_beams(const Octree& octree, const Camera& camera, OctreeWork& work) {
  const PrimaryRays rays(camera, 1, 1, 1);
  const EyeView view(octree.grid(), rays);
  BeamQueue queue;
  begin_beams(octree, view, queue);
  BeamStep step;
  while (!queue.waiting.empty()) {
    queue.waiting.pop(step);
    if (step.kind == BeamKind::kOccupied) work.occupied += 1.0;
    if (step.kind != BeamKind::kNonTerminal) continue;
    work.nonterminal += 1.0;
    if (!step.beam.crowded()) continue_beam(octree, view, step.beam, queue);
  }
}

double beam_cost(const OctreeWork& work, double handover) {
  const double build = 60.0 * work.nodes + 110.0 * work.references;
  double beams = 240.0 * work.nonterminal + 380.0 * work.occupied;
  if (handover > 0.0) {
    // A level of leaves before the eye has no more beams of `handover` samples than this.
    const double large = work.steps * work.rays / handover;
    beams *= std::min(1.0, large / std::max(1.0, work.nonterminal));
  }
  return build + beams + work.rays * work.hit_share * (6.6 * work.steps + 6.6 * work.tests);
}

}  // namespace beambench

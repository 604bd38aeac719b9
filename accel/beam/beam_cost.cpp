#include "accel/beam/beam_cost.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "accel/beam/beam_paths.hpp"

namespace beambench::accel::beam {
namespace {

constexpr int kWindows = 8;  // per row and per column

/// Returns the ratio of a window's side to that of its part of the image: chosen for four beams per
/// thousand rays, so that counting takes about 1% of the tracing time.
double window_size(double rays, double beams) {
  return std::clamp(std::sqrt(0.004 * rays / std::max(1.0, beams)), 1.0 / 32.0, 1.0 / 4.0);
}

/// Returns a window in its part of the image, but not in the middle, which may show the scene's
/// middle planes edge-on.
ImagePolygon window(int column, int row, double size) {
  // Kronecker sequence of the plastic number: evenly distributed in both directions.
  const double number = row * kWindows + column + 1.0;
  const double across = std::fmod(number * 0.7548776662466927, 1.0);
  const double down = std::fmod(number * 0.5698402909980532, 1.0);
  const double left = column + (1.0 - size) * across;
  const double top = row + (1.0 - size) * down;
  ImagePolygon corners;
  for (const glm::dvec2 corner :
       {glm::dvec2(left, top), glm::dvec2(left + size, top), glm::dvec2(left + size, top + size),
        glm::dvec2(left, top + size)}) {
    corners.push_back(corner / static_cast<double>(kWindows));
  }
  return corners;
}

/// Returns whether the window's left or lower edge cuts a beam. Such a beam is not counted; all
/// other beams that overlap the window are. So each beam, whatever its size, is counted with a
/// probability equal to the window's share of the image (Gundersen's unbiased counting frame:
/// "Notes on the estimation of the numerical density of arbitrary profiles: the edge effect",
/// Journal of Microscopy 111(2), 1977).
bool forbidden(const ImagePolygon& outline, const ImagePolygon& window) {
  constexpr double kNear = 1e-9;
  for (const glm::dvec2& corner : outline) {
    if (corner.x <= window[0].x + kNear || corner.y >= window[2].y - kNear) return true;
  }
  return false;
}

struct Counted {
  std::size_t nonterminal = 0;
  std::size_t occupied = 0;
};

void count_through(const octree::Octree& octree, const EyeView& view, const ImagePolygon& window,
                   Counted& counted) {
  BeamQueue queue;
  begin_beams(octree, view, window, queue);
  BeamStep step;
  while (!queue.waiting.empty()) {
    queue.waiting.pop(step);
    const std::size_t one = forbidden(step.beam.outline, window) ? 0 : 1;
    if (step.kind == BeamKind::kOccupied) counted.occupied += one;
    if (step.kind != BeamKind::kNonTerminal) continue;
    counted.nonterminal += one;
    if (!step.beam.crowded()) continue_beam(octree, view, step.beam, queue);
  }
}

}  // namespace

void count_beams(const octree::Octree& octree, const Workload& workload,
                 const octree::OctreeWork& expected, octree::OctreeWork& work) {
  const PrimaryRays rays(workload.camera, 1, 1, 1);
  const EyeView view(octree.grid(), rays);
  const double size = window_size(static_cast<double>(workload.rays), expected.nonterminal);
  Counted counted;
  for (int row = 0; row < kWindows; ++row) {
    for (int column = 0; column < kWindows; ++column) {
      count_through(octree, view, window(column, row, size), counted);
    }
  }
  work.nonterminal = static_cast<double>(counted.nonterminal) / (size * size);
  work.occupied = static_cast<double>(counted.occupied) / (size * size);
}

double beam_trace_cost(const octree::OctreeWork& work, double handover) {
  double beams = 205.0 * work.nonterminal + 600.0 * work.occupied;
  if (handover > 0.0) {
    // A level of leaves in front of the eye has at most this many beams of `handover` samples.
    const double large = work.steps * work.rays / handover;
    beams *= std::min(1.0, large / std::max(1.0, work.nonterminal));
  }
  const double sample = 8.0 + 4.9 * work.steps;
  return beams + work.rays * (work.hit_share * sample + 7.6 * work.tests);
}

}  // namespace beambench::accel::beam

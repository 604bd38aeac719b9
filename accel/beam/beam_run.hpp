#pragma once
// Traces an image by beams through any kind of cells.

#include <algorithm>
#include <cstdint>
#include <span>

#include "accel/beam/beam_options.hpp"
#include "accel/beam/beam_painter.hpp"
#include "accel/beam/beam_paths.hpp"
#include "accel/beam/beam_sight.hpp"
#include "accel/beam/octree_cells.hpp"

namespace beambench::accel::beam {

/// One image being traced, or one thread's share of it.
template <class Watch, class Sight, class Cells = OctreeCells>
class BeamRun {
 public:
  /// All arguments except `cells` and `rules` must outlive this object.
  BeamRun(const scenes::Scene& scene, const Cells& cells, const BeamRules& rules,
          const PrimaryRays& rays, const Sight& sight, const HitSpan& buffer,
          std::span<std::uint8_t> finished, Watch& watch)
      : cells_(cells),
        view_(sight.view(cells_.grid(), rays)),
        sight_(&sight),
        painter_(scene, cells, rules, view_, rays, sight, buffer, finished, watch),
        samples_(static_cast<double>(rays.count())),
        handover_(sight.handover(rules)),
        buffer_(buffer),
        watch_(&watch) {
    queue_.passed = sight.passed();
  }

  /// Traces the whole image.
  void operator()() {
    begin();
    work([](BeamStack&) {});
    end();
  }

  /// Makes all samples background and queues the first beams.
  void begin() {
    std::fill_n(buffer_.t(), buffer_.size(), kInfinity);
    std::fill_n(buffer_.primitive(), buffer_.size(), scenes::kNoPrimitive);
    cells_.begin(view_, sight_->part(view_), queue_);
  }

  BeamStack& waiting() { return queue_.waiting; }

  /// Traces beams until none is pending. Before each beam, `share(waiting)` may remove some pending
  /// beams.
  template <class Share>
  void work(Share share) {
    BeamStep step;
    while (!queue_.waiting.empty()) {
      share(queue_.waiting);
      queue_.waiting.pop(step);
      watch_->met(step.kind, step.beam);
      switch (step.kind) {
        case BeamKind::kLeaving:
          painter_.leave(step.beam);
          break;
        case BeamKind::kOccupied:
          if (painter_.test_leaf(step.beam)) continue_with(step.beam);
          break;
        case BeamKind::kNonTerminal:
          continue_with(step.beam);
          break;
      }
    }
    watch_->resting();
  }

  void end() {
    watch_->divided(queue_);
    watch_->finished();
  }

 private:
  void continue_with(const Beam& beam) {
    if (beam.crowded()) {
      painter_.hand_over(beam, RayReason::kCrowded);
    } else if (handover_ > 0 && area(beam.outline) * samples_ < static_cast<double>(handover_)) {
      painter_.hand_over(beam, RayReason::kHandover);
    } else {
      cells_.advance(view_, beam, queue_);
    }
  }

  Cells cells_;
  EyeView view_;
  const Sight* sight_;
  BeamPainter<Watch, Sight, Cells> painter_;
  double samples_;
  std::int64_t handover_;
  HitSpan buffer_;
  Watch* watch_;
  BeamQueue queue_;
};

}  // namespace beambench::accel::beam

#include "harness/cluster/task_sources.hpp"

#include <algorithm>

#include "scenes/core/error.hpp"

namespace beambench::cluster {

BeamSource::BeamSource(const accel::beam::BeamTracer& tracer, const accel::PrimaryRays& rays)
    : tracer_(&tracer),
      view_(tracer.octree().grid(), rays),
      samples_(static_cast<double>(rays.count())) {
  if (!tracer.options().continue_with_rays) {
    throw InputError(
        "continue=beams cannot be shared out: what passes a leaf would have to come back as a "
        "beam; leave it at continue=rays");
  }
  accel::beam::begin_beams(tracer.octree(), view_, view_.screen(), queue_);
}

bool BeamSource::next(Bytes& task) {
  accel::beam::BeamStep step;
  while (!queue_.waiting.empty()) {
    queue_.waiting.pop(step);
    if (step.kind == accel::BeamKind::kLeaving) continue;
    const auto kind =
        step.kind == accel::BeamKind::kOccupied ? BeamTask::Kind::kTestLeaf : as_rays(step.beam);
    if (kind) {
      write_task({*kind, step.beam}, tracer_->octree(), task);
      return true;
    }
    accel::beam::continue_beam(tracer_->octree(), view_, step.beam, queue_);
  }
  return false;
}

std::optional<BeamTask::Kind> BeamSource::as_rays(const accel::beam::Beam& beam) const {
  if (beam.crowded()) return BeamTask::Kind::kCrowded;
  const auto least = static_cast<double>(tracer_->options().handover);
  if (least > 0.0 && accel::beam::area(beam.outline) * samples_ < least)
    return BeamTask::Kind::kSmall;
  return std::nullopt;
}

BlockSource::BlockSource(int width, int height, int size)
    : width_(width), height_(height), size_(size) {}

bool BlockSource::next(Bytes& task) {
  if (top_ >= height_) return false;
  write_task({left_, top_, std::min(size_, width_ - left_), std::min(size_, height_ - top_)}, task);
  left_ += size_;
  if (left_ >= width_) {
    left_ = 0;
    top_ += size_;
  }
  return true;
}

}  // namespace beambench::cluster

#include "harness/thesis/cluster/split/light_relay.hpp"

#include <utility>

#include "harness/base/stopwatch.hpp"

namespace beambench::cluster {

LightRelay::LightRelay(const PartTracer& tracer, const SceneSplit& split, ProcessId self,
                       LightOutbox& outbox, Answer answer)
    : tracer_(&tracer), split_(&split), self_(self), outbox_(&outbox), answer_(std::move(answer)) {}

void LightRelay::take(std::span<const std::byte> message) {
  received_.add(message.size());
  for (const LightRay& ray : read_light_rays(message)) {
    if (ray.cell >= split_->cells().count() || split_->owner(ray.cell) != self_) {
      throw ProtocolError("a ray of light for a cell of another process");
    }
    waiting_.push_back(ray);
  }
}

bool LightRelay::work() {
  if (waiting_.empty()) return false;
  const base::CpuStopwatch timer;
  for (std::size_t i = 0; i < kAtOnce && !waiting_.empty(); ++i) {
    trace(waiting_.front());
    waiting_.pop_front();
  }
  cpu_seconds_ += timer.seconds();
  return true;
}

void LightRelay::trace(const LightRay& light) {
  const auto [best, exit] = pass(*tracer_, light, tracer_->entry(light.cell, light.t));
  if (!exit) return answer_({light.number, best});
  outbox_->hand_over({exit->cell, light.number, light.query, light.ray, exit->t, best});
}

PartTracer::Passage pass(const PartTracer& tracer, const LightRay& light,
                         const PartTracer::Place& from) {
  if (light.query == LightQuery::kAny) return tracer.any(light.ray, from);
  return tracer.closest(light.ray, from, light.best);
}

}  // namespace beambench::cluster

#pragma once
// Traces rays of light in one process's part of a scene.

#include <cstddef>
#include <deque>
#include <functional>
#include <span>

#include "harness/thesis/cluster/split/light_ray.hpp"
#include "harness/thesis/cluster/split/part_tracer.hpp"

namespace beambench::cluster {

/// Traces the rays that enter its part: sends the results of rays that end there, and passes the
/// others on.
class LightRelay {
 public:
  using Answer = std::function<void(const LightAnswer&)>;

  /// `answer` receives the results of rays that end here. Tracer and outbox must outlive this
  /// object.
  LightRelay(const PartTracer& tracer, const SceneSplit& split, ProcessId self, LightOutbox& outbox,
             Answer answer);

  /// Queues the rays of a message. Throws ProtocolError if a ray enters another process's cell.
  void take(std::span<const std::byte> message);
  /// Traces some of the queued rays; returns false if there are none.
  bool work();

  const Traffic& received() const { return received_; }
  double cpu_seconds() const { return cpu_seconds_; }

 private:
  /// The number of rays traced between two polls for messages.
  static constexpr std::size_t kAtOnce = 256;
  void trace(const LightRay& light);

  const PartTracer* tracer_;
  const SceneSplit* split_;
  ProcessId self_;
  LightOutbox* outbox_;
  Answer answer_;
  std::deque<LightRay> waiting_;
  Traffic received_;
  double cpu_seconds_ = 0.0;
};

/// Returns how a ray continues from a place with its best hit so far.
PartTracer::Passage pass(const PartTracer& tracer, const LightRay& light,
                         const PartTracer::Place& from);

}  // namespace beambench::cluster

// An image by beams on several threads.

#include <memory>
#include <type_traits>
#include <utility>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_group.h>

#include "accel/beam/beam_tracer.hpp"

namespace beambench::accel::beam {

/// Each thread traces beams from a stack of its own, and turns half of it into a task whenever many
/// wait.
template <class Watch>
class BeamTracer::SharedRun {
 public:
  using Counting = std::conditional_t<std::is_same_v<Watch, NoBeamWatch>, NoCounting, WorkCounters>;

  SharedRun(const BeamTracer& tracer, const PrimaryRays& rays, HitBuffer& buffer)
      : finished_(finished_samples(tracer.options(), sight_, buffer)),
        workers_([this, &tracer, &rays, &buffer] {
          return std::make_unique<Worker>(tracer, rays, sight_, buffer, finished_);
        }) {}

  void operator()(Counting& counting) {
    Worker& first = *workers_.local();
    first.run.begin();
    hand_over(std::exchange(first.run.waiting(), {}));
    tasks_.wait();
    for (const auto& worker : workers_) {
      worker->run.end();
      counting.add(worker->counting);
    }
  }

 private:
  /// From this number on half of the waiting beams are worth a task.
  static constexpr std::size_t kMany = 16;

  /// The state of one thread.
  struct Worker {
    Worker(const BeamTracer& tracer, const PrimaryRays& rays, const WholeImage& sight,
           HitBuffer& buffer, std::span<std::uint8_t> finished)
        : watch(watch_of(counting)), run(tracer, rays, sight, buffer, finished, watch) {}

    static Watch watch_of(Counting& counting) {
      if constexpr (std::is_same_v<Watch, NoBeamWatch>) {
        return {};
      } else {
        return Watch(counting);
      }
    }

    Counting counting;
    Watch watch;
    Run<Watch, WholeImage> run;
  };

  void hand_over(BeamStack beams) {
    tasks_.run([this, shared = std::make_shared<BeamStack>(std::move(beams))] {
      Run<Watch, WholeImage>& run = workers_.local()->run;
      run.waiting() = std::move(*shared);
      run.work([this](BeamStack& waiting) {
        if (waiting.size() >= kMany) hand_over(waiting.take_older_half());
      });
    });
  }

  WholeImage sight_;
  std::vector<std::uint8_t> finished_;
  tbb::enumerable_thread_specific<std::unique_ptr<Worker>> workers_;
  tbb::task_group tasks_;
};

void BeamTracer::trace_shared(const PrimaryRays& rays, HitBuffer& buffer,
                              WorkCounters* counters) const {
  if (counters != nullptr) return SharedRun<CountingBeamWatch>(*this, rays, buffer)(*counters);
  NoCounting none;
  SharedRun<NoBeamWatch>(*this, rays, buffer)(none);
}

}  // namespace beambench::accel::beam

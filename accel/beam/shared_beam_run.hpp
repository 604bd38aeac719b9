#pragma once
// Traces an image by beams on several threads.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_group.h>

#include "accel/beam/beam_run.hpp"
#include "accel/core/threads.hpp"

namespace beambench::accel::beam {

/// Traces an image on several threads. Each thread traces beams from its own stack; whenever many
/// are pending, it hands half of them over as a new task.
template <class Watch, class Cells = OctreeCells>
class SharedBeamRun {
 public:
  using Counting = std::conditional_t<std::is_same_v<Watch, NoBeamWatch>, NoCounting, WorkCounters>;

  /// All arguments except `cells` and `rules` must outlive this object.
  SharedBeamRun(const scenes::Scene& scene, const Cells& cells, const BeamRules& rules,
                const PrimaryRays& rays, const HitSpan& buffer)
      : finished_(finished_samples(rules, sight_, buffer)),
        workers_([this, &scene, cells, rules, &rays, buffer = HitSpan(buffer)] {
          return std::make_unique<Worker>(scene, cells, rules, rays, sight_, buffer, finished_);
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
  /// The minimum number of pending beams for which half of them are worth a task.
  static constexpr std::size_t kMany = 16;

  /// The state of one thread.
  struct Worker {
    Worker(const scenes::Scene& scene, const Cells& cells, const BeamRules& rules,
           const PrimaryRays& rays, const WholeImage& sight, const HitSpan& buffer,
           std::span<std::uint8_t> finished)
        : watch(watch_of(counting)),
          run(scene, cells, rules, rays, sight, buffer, finished, watch) {}

    static Watch watch_of(Counting& counting) {
      if constexpr (std::is_same_v<Watch, NoBeamWatch>) {
        return {};
      } else {
        return Watch(counting);
      }
    }

    Counting counting;
    Watch watch;
    BeamRun<Watch, WholeImage, Cells> run;
  };

  void hand_over(BeamStack beams) {
    tasks_.run([this, shared = std::make_shared<BeamStack>(std::move(beams))] {
      BeamRun<Watch, WholeImage, Cells>& run = workers_.local()->run;
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

/// Traces an image in beams, which the context's threads share.
template <class Cells>
void trace_image_in_beams(const scenes::Scene& scene, const Cells& cells, const BeamRules& rules,
                          const PrimaryRays& rays, const HitSpan& hits,
                          const QueryContext& context) {
  const auto trace = [&]<class Watch, class Counting>(Watch watch, Counting& counting) {
    if (thread_count(context.threads) == 1) {
      const WholeImage sight;
      auto finished = finished_samples(rules, sight, hits);
      return BeamRun<Watch, WholeImage, Cells>(scene, cells, rules, rays, sight, hits, finished,
                                               watch)();
    }
    on_threads(context.threads,
               [&] { SharedBeamRun<Watch, Cells>(scene, cells, rules, rays, hits)(counting); });
  };
  if (context.counters != nullptr) {
    return trace(CountingBeamWatch(*context.counters), *context.counters);
  }
  NoCounting none;
  trace(NoBeamWatch(), none);
}

}  // namespace beambench::accel::beam

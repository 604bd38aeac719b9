#pragma once
// The light of a picture of a divided scene, once its hits are found.

#include <functional>
#include <future>
#include <vector>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/whitted_picture.hpp"
#include "harness/thesis/cluster/report.hpp"
#include "harness/thesis/cluster/split/divided_scene.hpp"
#include "harness/thesis/cluster/split/light_exchange.hpp"
#include "harness/thesis/cluster/split/light_relay.hpp"
#include "harness/thesis/cluster/split/part_worker.hpp"
#include "harness/thesis/cluster/transport.hpp"

namespace beambench::cluster {

/// What a process did for the light.
struct LightReport {
  std::uint64_t rays_out = 0;     ///< shadow, mirror and refracted rays handed to other processes
  std::uint64_t answers_out = 0;  ///< to process 0
  Traffic out;                    ///< messages with rays or answers
  Traffic rays_in;                ///< messages with rays
  double cpu_seconds = 0.0;       ///< in tracing; of process 0: in all, shading included
};

/// A picture, and how it came about.
struct DrawnLight {
  render::Image image;
  render::RayCensus census;
  std::vector<LightReport> reports;  ///< by process
  double seconds;                    ///< wall time
};

/// Process 0 shades, as `whitted_picture` does, over a `DividedScene`; the others trace what enters
/// their parts. Each batch of Whitted's rays is a round: its rays go from part to part on their
/// own, whoever finishes one sends the answer to process 0, and the round is over when all are
/// there. So nothing has to be detected, and rounds of several parts of the picture overlap.
///
/// Process 0 must have the whole scene, without an octree: what it shades is anywhere.
///
/// No process can be replaced: process 0 ends the run if one is silent.
class LightLeader {
 public:
  /// `timeout`: seconds of silence after which LostProcess is thrown. All must outlive it.
  LightLeader(Transport& transport, const PartWorker& worker, const SceneSplit& split,
              double timeout);

  /// Calls `asking` in another thread with the divided scene, and has answered what it asks, from
  /// any number of threads. The other processes are shut down at the end, even if that or `asking`
  /// throws. Only once. Returns the reports, by process.
  using Asking = std::function<void(const accel::Accelerator& divided)>;
  std::vector<LightReport> answer(const Asking& asking);

  /// The picture of a scene by that. `hits` are those of `rays` over `whole`.
  DrawnLight draw(const scenes::Scene& whole, const render::WhittedOptions& options,
                  const rays::HitCheck& check, const accel::PrimaryRays& rays,
                  const accel::HitBuffer& hits);

 private:
  void answer_until_done(std::future<void> asked);
  void handle(const Message& message);
  void require_signs();
  void end_others();
  void collect_reports();

  Transport* transport_;
  double timeout_;
  LightExchange exchange_;
  DividedScene scene_;
  LightOutbox outbox_;
  LightRelay relay_;
  std::vector<double> last_heard_;  ///< by process
  std::vector<LightReport> reports_;
  int missing_reports_;
};

/// On the other processes: traces what enters this part until process 0 ends that. Sends a sign of
/// life each `heartbeat_interval` seconds, even without work: nobody knows where a ray is.
void serve_light(Transport& transport, const PartWorker& worker, const SceneSplit& split,
                 double heartbeat_interval);

}  // namespace beambench::cluster

#pragma once
// Computes the light of a picture of a divided scene, once its hits are known.

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

/// The work of a process for the light.
struct LightReport {
  std::uint64_t rays_out = 0;     ///< shadow, mirror and refracted rays sent to other processes
  std::uint64_t answers_out = 0;  ///< results sent to process 0
  Traffic out;                    ///< messages with rays or results
  Traffic rays_in;                ///< messages with rays
  double cpu_seconds = 0.0;       ///< for tracing; on process 0, also for shading
};

/// A picture, and how it was made.
struct DrawnLight {
  render::Image image;
  render::RayCensus census;
  std::vector<LightReport> reports;  ///< by process
  double seconds;                    ///< wall time
};

/// Process 0 shades, as `whitted_picture` does, over a `DividedScene`; the others trace the rays
/// that enter their parts. Each batch of rays is a round. Its rays move from part to part
/// independently, and whichever process ends a ray sends the result to process 0. The round is over
/// when all results have arrived, so termination need not be detected, and rounds of several parts
/// of the picture overlap.
///
/// Process 0 must have the whole scene, because shaded points may be anywhere; it needs no octree
/// of it.
///
/// Processes cannot be replaced: process 0 ends the run if one is silent.
class LightLeader {
 public:
  /// `timeout` is the silence in seconds after which it throws LostProcess. All arguments must
  /// outlive this object.
  LightLeader(Transport& transport, const PartWorker& worker, const SceneSplit& split,
              double timeout);

  /// Calls `asking` with the divided scene in another thread, and traces the queries that it makes,
  /// from any number of threads. Shuts the other processes down at the end, even if an exception is
  /// thrown. May be called only once. Returns the reports, by process.
  using Asking = std::function<void(const accel::Accelerator& divided)>;
  std::vector<LightReport> answer(const Asking& asking);

  /// Returns the picture of a scene, made in this way. `hits` are the hits of `rays` over `whole`.
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

/// Traces the rays that enter this part, on a process other than 0, until process 0 ends the run.
/// Sends a heartbeat every `heartbeat_interval` seconds, even when idle, because it is not known
/// which process has a ray.
void serve_light(Transport& transport, const PartWorker& worker, const SceneSplit& split,
                 double heartbeat_interval);

}  // namespace beambench::cluster

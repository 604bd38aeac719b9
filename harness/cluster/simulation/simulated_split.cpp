#include "harness/cluster/simulation/simulated_split.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "harness/base/stopwatch.hpp"
#include "harness/cluster/split/split_studio.hpp"
#include "harness/rays/fingerprint.hpp"

namespace beambench::cluster {
namespace {

/// Does something, lets as much simulated time pass as it took, and adds it up.
template <class Work>
void do_for(const Spend& spend, double slowness, double& sum, Work work) {
  const base::CpuStopwatch timer;
  work();
  const double seconds = timer.seconds();
  sum += seconds;
  spend(slowness * seconds);
}

/// Tracing's own measure of what it does.
SplitMember::Meter meter_of(const Spend& spend, const Slowness& slowness, SplitProcess& process) {
  return [&spend, &slowness, &process](SplitWork work, double seconds) {
    double& sum = work == SplitWork::kWalking   ? process.walk_seconds
                  : work == SplitWork::kTesting ? process.test_seconds
                                                : process.take_seconds;
    sum += seconds;
    const double slow = work == SplitWork::kWalking ? slowness.walk : slowness.work;
    process.busy += slow * seconds;
    spend(slow * seconds);
  };
}

}  // namespace

SimulatedSplit simulate_split(const ClusterModel& cluster, const Job& job,
                              const std::shared_ptr<const scenes::Scene>& whole,
                              const Slowness& slowness, const char* program) {
  SimulatedSplit run;
  run.processes.resize(cluster.speeds.size());
  run.seconds = run_on(cluster, program, [&](Transport& transport, const Spend& spend) {
    SplitProcess& process = run.processes[static_cast<std::size_t>(transport.self())];
    std::optional<SplitStudio> studio;
    do_for(spend, slowness.build, process.build_seconds,
           [&] { studio.emplace(whole, job, transport); });
    process.ready = transport.seconds();
    SplitWorker& worker = studio->worker();
    SplitMember member(
        transport, worker, studio->outbox(), Transport::kForever,
        [](ProcessId, std::span<const std::byte>) {}, meter_of(spend, slowness, process));
    if (transport.self() != kProducer) {
      transport.send(kProducer, Tag::kReady, {});
      return member.follow([&] {
        Bytes result;
        do_for(spend, slowness.work, process.take_seconds,
               [&] { result = write_result(member.account(), worker); });
        return result;
      });
    }
    std::vector<Bytes> results = member.lead();
    const accel::PrimaryRays& rays = studio->rays();
    accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
    do_for(spend, slowness.work, process.take_seconds, [&] {
      results[kProducer] = write_result(member.account(), worker);
      for (std::size_t i = 0; i < results.size(); ++i) {
        run.processes[i].account = take_result(results[i], hits);
      }
    });
    run.result_hash = rays::fingerprint(hits);
  });
  double last_ready = 0.0;
  for (const SplitProcess& each : run.processes) last_ready = std::max(last_ready, each.ready);
  run.traced_seconds = run.seconds - last_ready;
  return run;
}

}  // namespace beambench::cluster

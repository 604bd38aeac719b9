#include "harness/cluster/simulation/simulate.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "harness/base/stopwatch.hpp"
#include "harness/cluster/consumer.hpp"
#include "harness/rays/fingerprint.hpp"

namespace beambench::cluster {
namespace {

ClusterReport replay_producer(Transport& transport, const Spend& spend, const TaskCosts& costs,
                              const ProducerOptions& options) {
  ReplayedSource source(costs, spend);
  ReplayedWorker own(costs, spend);
  ReplayedSink sink(costs, spend);
  const auto welcome = [](ProcessId, std::span<const std::byte>) {};
  return Producer(transport, source, sink, own, welcome, options).run();
}

/// Does the work, spends its scaled CPU time, and adds it up.
template <class Work>
void do_for(const Spend& spend, double scale, double& sum, Work work) {
  const base::CpuStopwatch timer;
  work();
  const double seconds = timer.seconds();
  sum += seconds;
  spend(scale * seconds);
}

/// Accounts for the time of each piece of work.
PartMember::Meter meter_of(const Spend& spend, const TimeScale& scale, SplitProcess& process) {
  return [&spend, &scale, &process](PartWork work, double seconds) {
    double& sum = work == PartWork::kWalking   ? process.walk_seconds
                  : work == PartWork::kTesting ? process.test_seconds
                                               : process.take_seconds;
    sum += seconds;
    const double factor = work == PartWork::kWalking ? scale.walk : scale.work;
    process.busy += factor * seconds;
    spend(factor * seconds);
  };
}

}  // namespace

SimulatedRun simulate(const ClusterModel& cluster, const TaskCosts& costs, double build_seconds,
                      const ProducerOptions& options, const char* program) {
  ProducerOptions patient = options;  // no process fails here, and long tasks send no heartbeat
  patient.timeout = patient.startup_timeout = Transport::kForever;
  SimulatedRun run;
  run.seconds = run_on(cluster, program, [&](Transport& transport, const Spend& spend) {
    spend(build_seconds);
    if (transport.self() == kProducer) {
      run.report = replay_producer(transport, spend, costs, patient);
    } else {
      ReplayedWorker worker(costs, spend);
      Consumer(transport, worker, patient.timeout).run({});
    }
  });
  return run;
}

SimulatedSplit simulate_split(const ClusterModel& cluster, const Job& job,
                              const std::shared_ptr<const scenes::Scene>& whole,
                              const TimeScale& scale, const char* program) {
  SimulatedSplit run;
  run.processes.resize(cluster.speeds.size());
  run.seconds = run_on(cluster, program, [&](Transport& transport, const Spend& spend) {
    SplitProcess& process = run.processes[static_cast<std::size_t>(transport.self())];
    std::optional<PartState> state;
    do_for(spend, scale.build, process.build_seconds,
           [&] { state.emplace(whole, job, transport); });
    process.ready = transport.seconds();
    PartWorker& worker = state->worker();
    PartMember member(
        transport, worker, state->outbox(), Transport::kForever,
        [](ProcessId, std::span<const std::byte>) {}, meter_of(spend, scale, process));
    if (transport.self() != kProducer) {
      transport.send(kProducer, Tag::kReady, {});
      return member.follow([&] {
        Bytes result;
        do_for(spend, scale.work, process.take_seconds,
               [&] { result = write_result(member.report(), worker); });
        return result;
      });
    }
    std::vector<Bytes> results = member.lead();
    const accel::PrimaryRays& rays = state->rays();
    accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
    do_for(spend, scale.work, process.take_seconds, [&] {
      results[kProducer] = write_result(member.report(), worker);
      for (std::size_t i = 0; i < results.size(); ++i) {
        run.processes[i].report = take_result(results[i], hits);
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

#include "harness/cluster/simulation/simulated_cluster.hpp"

#include "harness/cluster/consumer.hpp"
#include "harness/cluster/simulation/replay.hpp"

namespace beambench::cluster {
namespace {

ClusterReport play_producer(Transport& transport, const Spend& spend, const TaskCosts& costs,
                            const ProducerOptions& options) {
  ReplayedSource source(costs, spend);
  ReplayedWorker own(costs, spend);
  ReplayedSink sink(costs, spend);
  const auto welcome = [](ProcessId, std::span<const std::byte>) {};
  return Producer(transport, source, sink, own, welcome, options).run();
}

}  // namespace

SimulatedRun simulate(const ClusterModel& cluster, const TaskCosts& costs, double build_seconds,
                      const ProducerOptions& options, const char* program) {
  ProducerOptions patient = options;  // nobody dies here, and long tasks send no sign of life
  patient.timeout = patient.patience = Transport::kForever;
  SimulatedRun run;
  run.seconds = run_on(cluster, program, [&](Transport& transport, const Spend& spend) {
    spend(build_seconds);
    if (transport.self() == kProducer) {
      run.report = play_producer(transport, spend, costs, patient);
    } else {
      ReplayedWorker worker(costs, spend);
      Consumer(transport, worker, patient.timeout).run({});
    }
  });
  return run;
}

}  // namespace beambench::cluster

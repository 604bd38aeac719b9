#include "harness/thesis/cluster/simulation/simulate.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <mpi.h>
#include <simgrid/Exception.hpp>
#include <simgrid/kernel/ProfileBuilder.hpp>
#include <simgrid/s4u.hpp>
#include <simgrid/version.h>

#include "harness/base/stopwatch.hpp"
#include "harness/rays/fingerprint.hpp"
#include "harness/thesis/cluster/consumer.hpp"
#include "harness/thesis/cluster/mpi_transport.hpp"

namespace beambench::cluster {
namespace {

namespace s4u = simgrid::s4u;

/// Operations per second of a machine of speed 1; an arbitrary number.
constexpr double kSpeedOne = 1e9;
constexpr const char* kProgram = "beambench-cluster";

/// Configures SimGrid: times and sizes are those of the model, without SimGrid's corrections for
/// modern clusters. The program's real computations take no simulated time, and MPI calls take the
/// time that `ChargedTransport` charges.
void configure() {
  const auto set = [](const std::string& option) { s4u::Engine::set_config(option); };
  set("network/model:CM02");
  set("network/bandwidth-factor:1");
  set("network/latency-factor:1");
  set("network/weight-S:0");
  set("network/TCP-gamma:0");
  set("network/crosstraffic:no");
  set("smpi/simulate-computation:no");
  set("smpi/cpu-threshold:0");  // otherwise less than a microsecond takes no time
  set(fmt::format("smpi/host-speed:{}f", kSpeedOne));
  set("smpi/bw-factor:1");
  set("smpi/lat-factor:1");
  // Messages leave immediately and wait at the receiver, whatever their size.
  set("smpi/async-small-thresh:1073741824");
  set("smpi/send-is-detached-thresh:1073741824");
  set("smpi/iprobe:0");
  set("smpi/test:0");
  set("smpi/wtime:0");
  set("smpi/init:0");
}

/// Alternates between full speed and the share of the speed that other users leave.
simgrid::kernel::profile::Profile* load_of(const std::string& name, const ClusterModel& cluster) {
  const std::string points =
      fmt::format("0 1\n{} {}\n", 0.5 * cluster.load_period, cluster.loaded_share);
  return simgrid::kernel::profile::ProfileBuilder::from_string(name, points, cluster.load_period);
}

/// SimGrid 4 creates the root zone itself, and only zones inside the root accept the models set up
/// here.
s4u::NetZone* make_zone() {
#if SIMGRID_VERSION_MAJOR >= 4
  return s4u::Engine::get_instance()->get_netzone_root()->add_netzone_star("cluster");
#else
  return s4u::create_star_zone("cluster");
#endif
}

std::vector<s4u::Host*> make_machines(const ClusterModel& cluster) {
  auto* zone = make_zone();
  s4u::Link* medium = nullptr;
  if (cluster.network == ClusterModel::Network::kShared) {
    medium = zone->create_link("medium", cluster.bytes_per_second);
    medium->set_latency(cluster.latency_seconds)->seal();
  }
  std::vector<s4u::Host*> machines;
  for (std::size_t i = 0; i < cluster.speeds.size(); ++i) {
    const std::string name = fmt::format("machine-{}", i);
    auto* machine = zone->create_host(name, cluster.speeds[i] * kSpeedOne);
    if (i + cluster.loaded >= cluster.speeds.size()) {
      machine->set_speed_profile(load_of(name + "-load", cluster));
    }
    machine->seal();
    if (medium != nullptr) {
      // The route has the same single link, whichever machine sends.
      zone->add_route(machine->get_netpoint(), nullptr, nullptr, nullptr,
                      {s4u::LinkInRoute(medium)}, false);
      zone->add_route(nullptr, machine->get_netpoint(), nullptr, nullptr,
                      std::vector<s4u::LinkInRoute>{}, false);
    } else {
      auto* line = zone->create_split_duplex_link(name + "-line", cluster.bytes_per_second);
      line->set_latency(0.5 * cluster.latency_seconds)->seal();
      zone->add_route(machine->get_netpoint(), nullptr, nullptr, nullptr,
                      {s4u::LinkInRoute(line, s4u::LinkInRoute::Direction::UP)}, true);
    }
    machines.push_back(machine);
  }
  zone->seal();
  return machines;
}

/// The main function of a process. Simulated time passes only through `spend` and through messages.
using ProcessMain = std::function<void(Transport& transport, const Spend& spend)>;

/// Data shared by the processes, which are simulated one at a time.
struct Stage {
  MessageCost message_cost;
  const ProcessMain& process;
  int ended = 0;
  double seconds = 0.0;
  std::exception_ptr problem;
};

void run_process_main(Stage& stage) {
  MpiTransport carrier(MpiTransport::Waiting::kBlocking);
  ChargedTransport transport(carrier, stage.message_cost, smpi_execute);
  stage.process(transport, smpi_execute);
  stage.seconds = std::max(stage.seconds, transport.seconds());
  // Waits for all processes, because messages that have not arrived would be lost with their
  // sender.
  MPI_Comm everybody = MPI_COMM_NULL;
  MPI_Comm_dup(MPI_COMM_WORLD, &everybody);
  MPI_Barrier(everybody);
  ++stage.ended;
}

/// Runs one process. An exception ends all processes without MPI_Finalize, in which each would wait
/// for the others.
void live(Stage& stage) {
  try {
    MPI_Init(nullptr, nullptr);
    run_process_main(stage);
    MPI_Finalize();
  } catch (const simgrid::ForcefulKillException&) {
    throw;  // ends a process in SimGrid
  } catch (...) {
    stage.problem = std::current_exception();
    s4u::Actor::kill_all();
    s4u::this_actor::exit();
  }
}

/// Runs `process` on each machine of a cluster, and returns the time in seconds until the last one
/// ends. `program` is the name of this program, for SimGrid's messages. Throws what a process
/// throws, and std::runtime_error for a deadlock. May be called only once per program, because
/// SimGrid has a single engine.
double run_on(const ClusterModel& cluster, const char* program, const ProcessMain& process) {
  std::string name(program);
  std::string quiet("--log=root.thres:warning");
  std::array<char*, 3> arguments{name.data(), quiet.data(), nullptr};
  int count = 2;
  s4u::Engine engine(&count, arguments.data());
  configure();
  SMPI_init();
  const std::vector<s4u::Host*> machines = make_machines(cluster);
  const int processes = static_cast<int>(machines.size());
  SMPI_app_instance_register(kProgram, nullptr, processes);
  Stage stage{cluster.message_cost, process, 0, 0.0, nullptr};
  for (int i = 0; i < processes; ++i) {
    const auto process =
        s4u::Actor::init(fmt::format("process-{}", i), machines[static_cast<std::size_t>(i)]);
    process->set_property("instance_id", kProgram);
    process->set_property("rank", std::to_string(i));
    process->start([&stage] { live(stage); });
  }
  engine.run();
  SMPI_finalize();
  if (stage.problem) std::rethrow_exception(stage.problem);
  if (stage.ended < processes) {
    throw std::runtime_error("deadlock: the simulated processes wait for each other");
  }
  return stage.seconds;
}

ClusterReport replay_producer(Transport& transport, const Spend& spend, const TaskCosts& costs,
                              const ProducerOptions& options, ReplayedSource& source) {
  ReplayedWorker own(costs, spend);
  ReplayedSink sink(costs, spend);
  const auto welcome = [](ProcessId, std::span<const std::byte>) {};
  return Producer(transport, source, sink, own, welcome, options).run();
}

/// Does the work, spends its scaled CPU time, and adds its CPU time to `sum`.
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

SimulatedRun simulate(const ClusterModel& cluster, const Replay& replay, const char* program) {
  const int consumers = std::max(1, static_cast<int>(cluster.speeds.size()) - 1);
  std::vector<Share> plan;
  TaskCosts costs = replay.costs;
  if (replay.division) plan = planned(*replay.division, costs, consumers);
  if (replay.division == ImageDivision::kFalling) {
    costs = merged(costs, std::exchange(plan, {}), replay.stored);
  }
  ProducerOptions patient =
      replay.options;  // processes do not fail here, and long tasks do not send heartbeats
  patient.timeout = patient.startup_timeout = Transport::kForever;
  SimulatedRun run;
  run.seconds = run_on(cluster, program, [&](Transport& transport, const Spend& spend) {
    spend(replay.build_seconds);
    if (transport.self() == kProducer) {
      ReplayedSource source(costs, spend, plan, replay.pre_pass_seconds);
      run.report = replay_producer(transport, spend, costs, patient, source);
    } else {
      ReplayedWorker worker(costs, spend);
      consume(transport, worker, patient.timeout, {});
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
    PartWorker& worker = *state->worker;
    PartMember member(
        transport, worker, state->outbox, Transport::kForever,
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
    const accel::PrimaryRays& rays = state->rays;
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

#include "harness/cluster/simulation/machines.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <mpi.h>
#include <simgrid/Exception.hpp>
#include <simgrid/kernel/ProfileBuilder.hpp>
#include <simgrid/s4u.hpp>

#include "harness/cluster/mpi_transport.hpp"

namespace beambench::cluster {
namespace {

namespace s4u = simgrid::s4u;

/// Operations per second of a machine of speed 1; an arbitrary number.
constexpr double kSpeedOne = 1e9;
constexpr const char* kProgram = "beambench-cluster";

/// Times and sizes are those of the model, without SimGrid's corrections for today's clusters; what
/// the program really computes takes no time, and MPI's calls take what `ChargedTransport` charges.
void configure() {
  const auto set = [](const std::string& option) { s4u::Engine::set_config(option); };
  set("network/model:CM02");
  set("network/bandwidth-factor:1");
  set("network/latency-factor:1");
  set("network/weight-S:0");
  set("network/TCP-gamma:0");
  set("network/crosstraffic:no");
  set("smpi/simulate-computation:no");
  set("smpi/cpu-threshold:0");  // otherwise less than a microsecond would take no time
  set(fmt::format("smpi/host-speed:{}f", kSpeedOne));
  set("smpi/bw-factor:1");
  set("smpi/lat-factor:1");
  // Messages leave at once and wait at the receiver, whatever their size.
  set("smpi/async-small-thresh:1073741824");
  set("smpi/send-is-detached-thresh:1073741824");
  set("smpi/iprobe:0");
  set("smpi/test:0");
  set("smpi/wtime:0");
  set("smpi/init:0");
}

/// Full speed, and the share of it that others leave.
simgrid::kernel::profile::Profile* load_of(const std::string& name, const ClusterModel& cluster) {
  const std::string points =
      fmt::format("0 1\n{} {}\n", 0.5 * cluster.load_period, cluster.loaded_share);
  return simgrid::kernel::profile::ProfileBuilder::from_string(name, points, cluster.load_period);
}

std::vector<s4u::Host*> make_machines(const ClusterModel& cluster) {
  auto* zone = s4u::create_star_zone("cluster");
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
      // One link on the route, whoever sends.
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

/// Shared by the processes, which are simulated one at a time.
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
  // Messages that have not arrived would be lost with their sender.
  MPI_Comm everybody = MPI_COMM_NULL;
  MPI_Comm_dup(MPI_COMM_WORLD, &everybody);
  MPI_Barrier(everybody);
  ++stage.ended;
}

/// One process. An exception ends them all, without MPI_Finalize, where each would wait for the
/// others.
void live(Stage& stage) {
  try {
    MPI_Init(nullptr, nullptr);
    run_process_main(stage);
    MPI_Finalize();
  } catch (const simgrid::ForcefulKillException&) {
    throw;  // how SimGrid ends a process
  } catch (...) {
    stage.problem = std::current_exception();
    s4u::Actor::kill_all();
    s4u::this_actor::exit();
  }
}

}  // namespace

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

}  // namespace beambench::cluster

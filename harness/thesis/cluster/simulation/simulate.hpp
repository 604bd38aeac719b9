#pragma once
// Runs on machines and a network simulated by SimGrid. Producer and consumers replay a record. A
// divided scene is actually traced during the simulation, because the handoffs between processes,
// and their messages, depend on timing.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "harness/thesis/cluster/image_division.hpp"
#include "harness/thesis/cluster/job.hpp"
#include "harness/thesis/cluster/producer.hpp"
#include "harness/thesis/cluster/simulation/replay.hpp"
#include "harness/thesis/cluster/split/part_member.hpp"

namespace beambench::cluster {

/// The machines and the network of a cluster. Speeds are relative: a machine of speed 1 takes the
/// recorded seconds.
struct ClusterModel {
  enum class Network {
    kShared,   ///< one medium for all, as in Ethernet with hubs or coaxial cable
    kSwitched  ///< a separate line in each direction for each machine
  };
  Network network = Network::kSwitched;
  double bytes_per_second = 1.25e7;  ///< of the medium, or of each line
  double latency_seconds = 1e-4;     ///< between any two machines
  MessageCost message_cost{1e-4, 0.0, 2e-5};
  std::vector<double> speeds;  ///< of each process's machine
  std::size_t loaded = 0;      ///< number of machines (the last ones) with other users
  double loaded_share = 0.5;   ///< share of their speed that other users leave
  double load_period = 20.0;   ///< seconds; other users are active in the second half
};

/// The producer's report, and the time of the whole run.
struct SimulatedRun {
  double seconds = 0.0;  ///< from the start of the processes to the end of the last one
  ClusterReport report;
};

/// The run to be replayed. Seconds are those of a machine of speed 1.
struct Replay {
  TaskCosts costs;
  double build_seconds = 0.0;             ///< of every process, for its octree
  std::optional<ImageDivision> division;  ///< nothing: the tasks in order, according to `options`
  bool stored = false;                    ///< results stay with their consumers, see `merged`
  double pre_pass_seconds = 0.0;          ///< of the producer, before the first task
  ProducerOptions options;
};

/// Runs producer and consumers on the cluster, with the producer on the first machine. `program` is
/// the name of this program, for SimGrid's messages. Throws what a process or `planned` throws, and
/// std::runtime_error for a deadlock. May be called only once per program.
SimulatedRun simulate(const ClusterModel& cluster, const Replay& replay, const char* program);

/// The ratios of times on a machine of speed 1 to times on this machine.
struct TimeScale {
  double build = 1.0;  ///< to divide the scene and to build
  double walk = 1.0;   ///< to trace beams
  double work = 1.0;   ///< for everything else
};

/// The work of a process, in CPU seconds of this machine.
struct SplitProcess {
  PartReport report;
  double build_seconds = 0.0;  ///< to divide the scene and to build its part
  double walk_seconds = 0.0;
  double test_seconds = 0.0;  ///< to trace samples and rays
  double take_seconds = 0.0;  ///< to receive handoffs and, at the end, hits
  double ready = 0.0;         ///< simulated: time at which it was ready
  double busy = 0.0;          ///< simulated: time of traversal, tests and receiving
};

struct SimulatedSplit {
  double seconds = 0.0;         ///< simulated: up to the end of the last process
  double traced_seconds = 0.0;  ///< the part of `seconds` after the last process was ready
  std::uint64_t result_hash = 0;
  std::vector<SplitProcess> processes;
};

/// Traces `job`; each process of the cluster traces its part of the scene. Reading the scene takes
/// no simulated time. Other than that, like `simulate`.
SimulatedSplit simulate_split(const ClusterModel& cluster, const Job& job,
                              const std::shared_ptr<const scenes::Scene>& whole,
                              const TimeScale& scale, const char* program);

}  // namespace beambench::cluster

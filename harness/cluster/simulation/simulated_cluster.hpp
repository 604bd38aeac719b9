#pragma once
// A cluster that is not there: the producer and the consumers run on machines and a network that
// SimGrid computes.

#include <vector>

#include "harness/cluster/process_report.hpp"
#include "harness/cluster/producer.hpp"
#include "harness/cluster/simulation/charged_transport.hpp"
#include "harness/cluster/simulation/task_costs.hpp"

namespace beambench {

/// Speeds are relative: a machine of speed 1 takes the recorded seconds.
struct ClusterModel {
  enum class Network {
    kShared,   ///< one medium for all, as in an Ethernet with hubs or coaxial cable
    kSwitched  ///< for each machine a line of its own in both directions
  };
  Network network = Network::kSwitched;
  double bytes_per_second = 1.25e7;  ///< of the medium, or of each line
  double latency_seconds = 1e-4;     ///< between any two machines
  MessageCost message_cost{1e-4, 0.0, 2e-5};
  std::vector<double> speeds;  ///< of the producer's machine and of the consumers'
  std::size_t loaded = 0;      ///< so many, the last ones, are used by others, too:
  double loaded_share = 0.5;   ///< what is left of them meanwhile
  double load_period = 20.0;   ///< seconds, during the second half of which they are used
};

/// What the producer reported, and how long all of it took.
struct SimulatedRun {
  double seconds = 0.0;  ///< from the start of the processes to the end of the last one
  ClusterReport report;
};

/// Runs the program on the cluster, a process for each speed: everybody first builds its octree for
/// `build_seconds` (of speed 1). `program` is the name of this one, for SimGrid's messages. Only
/// one call in the life of a program: SimGrid has one engine.
SimulatedRun simulate(const ClusterModel& cluster, const TaskCosts& costs, double build_seconds,
                      const ProducerOptions& options, const char* program);

}  // namespace beambench

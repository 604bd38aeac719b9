#pragma once
// Machines and a network that SimGrid simulates, and processes on them.

#include <functional>
#include <vector>

#include "harness/cluster/simulation/charged_transport.hpp"

namespace beambench::cluster {

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
  std::vector<double> speeds;  ///< of each process's machine
  std::size_t loaded = 0;      ///< number of machines, the last ones, that others use, too
  double loaded_share = 0.5;   ///< share of their speed that others leave
  double load_period = 20.0;   ///< seconds; others use them in the second half
};

/// One process. Only the time it spends passes, and that of its messages.
using ProcessMain = std::function<void(Transport& transport, const Spend& spend)>;

/// Runs `process` for each machine of a cluster, and returns the seconds to the end of the last
/// one. `program` is the name of this one, for SimGrid's messages. Throws what a process throws,
/// and std::runtime_error for a deadlock. Only one call per program: SimGrid has one engine.
double run_on(const ClusterModel& cluster, const char* program, const ProcessMain& process);

}  // namespace beambench::cluster

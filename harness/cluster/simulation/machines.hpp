#pragma once
// Machines and a network that SimGrid computes, and processes on them.

#include <functional>
#include <vector>

#include "harness/cluster/simulation/charged_transport.hpp"
#include "harness/cluster/simulation/spend.hpp"

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
  std::size_t loaded = 0;      ///< so many, the last ones, are used by others, too:
  double loaded_share = 0.5;   ///< what is left of them meanwhile
  double load_period = 20.0;   ///< seconds, during the second half of which they are used
};

/// What one process does. Only what it spends takes time, and its messages.
using Play = std::function<void(Transport& transport, const Spend& spend)>;

/// Runs `play` as the processes of a cluster, one for each speed, and returns the seconds to the
/// end of the last one. `program` is the name of this one, for SimGrid's messages. Throws what a
/// process throws, and std::runtime_error where they wait for each other for ever. Only one call in
/// the life of a program: SimGrid has one engine.
double run_on(const ClusterModel& cluster, const char* program, const Play& play);

}  // namespace beambench::cluster

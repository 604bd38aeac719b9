#pragma once
// A divided scene on a cluster that is not there. Unlike the producer's and the consumers' work,
// which is played from a record, a divided scene is really traced while it is simulated: who hands
// what to whom, and with what else in a message, follows from the times themselves.

#include <cstdint>
#include <memory>
#include <vector>

#include "harness/cluster/job.hpp"
#include "harness/cluster/simulation/machines.hpp"
#include "harness/cluster/split/split_member.hpp"

namespace beambench::cluster {

/// So many times as long as here a machine of speed 1 takes.
struct Slowness {
  double build = 1.0;  ///< to divide the scene and to build
  double walk = 1.0;   ///< to walk beams
  double work = 1.0;   ///< for all else
};

/// What a process did, in processor seconds of this machine.
struct SplitProcess {
  SplitAccount account;
  double build_seconds = 0.0;  ///< to divide the scene and to build its part
  double walk_seconds = 0.0;
  double test_seconds = 0.0;  ///< of samples and rays
  double take_seconds = 0.0;  ///< of what others handed over, and at the end of what they found
  double ready = 0.0;         ///< simulated: when it was built
  double busy = 0.0;          ///< simulated: how long it walked, tested and took
};

struct SimulatedSplit {
  double seconds = 0.0;         ///< simulated: from the start to the end of the last process
  double traced_seconds = 0.0;  ///< of it: since the last process was ready
  std::uint64_t result_hash = 0;
  std::vector<SplitProcess> processes;
};

/// Traces `job` over the whole scene, each process of the cluster with its part. To read the scene
/// takes no time: it is the same for all, and depends on how it is stored. As `run_on`.
SimulatedSplit simulate_split(const ClusterModel& cluster, const Job& job,
                              const std::shared_ptr<const scenes::Scene>& whole,
                              const Slowness& slowness, const char* program);

}  // namespace beambench::cluster

#pragma once
// A cluster that is not there: the producer and the consumers run on machines and a network that
// SimGrid computes.

#include "harness/cluster/process_report.hpp"
#include "harness/cluster/producer.hpp"
#include "harness/cluster/simulation/machines.hpp"
#include "harness/cluster/simulation/task_costs.hpp"

namespace beambench::cluster {

/// What the producer reported, and how long all of it took.
struct SimulatedRun {
  double seconds = 0.0;  ///< from the start of the processes to the end of the last one
  ClusterReport report;
};

/// Runs the program on the cluster, the producer on the first machine: everybody first builds its
/// octree for `build_seconds` (of speed 1). As `run_on`.
SimulatedRun simulate(const ClusterModel& cluster, const TaskCosts& costs, double build_seconds,
                      const ProducerOptions& options, const char* program);

}  // namespace beambench::cluster

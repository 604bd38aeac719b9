#pragma once
// How a cluster is described on a command line.

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "harness/cluster/simulation/machines.hpp"

namespace beambench::cluster {

struct ClusterRequested {
  ClusterModel model;
  std::string network = "switched";
  std::vector<double> speeds;
};
/// Adds options of network, messages and machines.
void add_cluster_options(CLI::App& app, ClusterRequested& cluster);

/// With a machine of speed 1 for process 0; the speeds that were given are repeated for the others.
ClusterModel cluster_of(const ClusterRequested& cluster, int processes);

}  // namespace beambench::cluster

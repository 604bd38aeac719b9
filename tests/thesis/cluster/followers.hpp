#pragma once
// A whole run as mpirun starts it, each process a thread.

#include <thread>
#include <vector>

#include "harness/thesis/cluster/job.hpp"
#include "harness/thesis/cluster/run.hpp"
#include "tests/thesis/cluster/local_network.hpp"

namespace beambench::cluster {

/// Returns the result of `lead` for the request on process 0, while all other processes follow.
template <class Lead>
auto led(Lead lead, const ClusterRequest& request, LocalNetwork& network) {
  std::vector<std::jthread> others;
  for (ProcessId process = 1; process < network.at(0).processes(); ++process) {
    others.emplace_back([&network, process] { follow(network.at(process)); });
  }
  Bytes job = write_job(request.job);
  network.at(0).broadcast(job);
  return lead(request, network.at(0));
}

}  // namespace beambench::cluster

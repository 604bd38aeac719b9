#include "harness/cluster/simulation/cluster_options.hpp"

namespace beambench::cluster {

void add_cluster_options(CLI::App& app, ClusterRequested& cluster) {
  const CLI::Range positive(1e-12, 1e12);
  const CLI::Range not_negative(0.0, 1e12);
  app.add_option("--network", cluster.network,
                 "shared: one medium for all; switched: a line in both directions for each machine")
      ->capture_default_str()
      ->check(CLI::IsMember({"shared", "switched"}));
  ClusterModel& model = cluster.model;
  app.add_option("--bandwidth", model.bytes_per_second, "Bytes a second, of the medium or a line")
      ->capture_default_str()
      ->check(positive);
  app.add_option("--latency", model.latency_seconds, "Seconds between two machines")
      ->capture_default_str()
      ->check(not_negative);
  app.add_option("--message-seconds", model.message_cost.message_seconds,
                 "Of the processor for a message, of the sender's and of the receiver's")
      ->capture_default_str()
      ->check(not_negative);
  app.add_option("--byte-seconds", model.message_cost.byte_seconds, "... and for each byte of it")
      ->capture_default_str()
      ->check(not_negative);
  app.add_option("--look-seconds", model.message_cost.look_seconds,
                 "Of the processor to look for messages where there is none")
      ->capture_default_str()
      ->check(positive);
  app.add_option("--speeds", cluster.speeds, "Of the machines but the first, repeated: 1,0.5")
      ->delimiter(',')
      ->check(positive);
  app.add_option("--loaded", model.loaded, "So many machines are used by others now and then");
  app.add_option("--loaded-share", model.loaded_share, "What others leave of them")
      ->capture_default_str()
      ->check(CLI::Range(1e-3, 1.0));
  app.add_option("--load-period", model.load_period,
                 "Seconds, in the second half of which others use them")
      ->capture_default_str()
      ->check(positive);
}

ClusterModel cluster_of(const ClusterRequested& cluster, int processes) {
  ClusterModel model = cluster.model;
  model.network = cluster.network == "shared" ? ClusterModel::Network::kShared
                                              : ClusterModel::Network::kSwitched;
  model.speeds.assign(1, 1.0);
  for (int i = 1; i < processes; ++i) {
    const std::size_t given = cluster.speeds.size();
    model.speeds.push_back(given == 0 ? 1.0
                                      : cluster.speeds[static_cast<std::size_t>(i - 1) % given]);
  }
  return model;
}

}  // namespace beambench::cluster

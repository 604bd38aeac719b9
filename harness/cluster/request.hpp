#pragma once
// What the command line of beambench-cluster asks for.

#include <optional>
#include <string>

#include "harness/cluster/job.hpp"
#include "harness/cluster/producer.hpp"
#include "harness/render/shading.hpp"

namespace beambench::cluster {

struct ClusterRequest {
  Job job;
  ProducerOptions producer;
  bool blocks = false;
  int block_size = 32;
  render::Shading shading = render::Shading::kPreview;
  std::string picture;  ///< file; empty: none
  std::string report;
  std::string tasks;
};

/// Nothing where the command line asked for help or the version, which were printed then. Throws
/// InputError for a wrong one, before anything long is begun.
std::optional<ClusterRequest> parse_request(int argc, char** argv);

}  // namespace beambench::cluster

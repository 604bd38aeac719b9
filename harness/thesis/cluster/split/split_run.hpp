#pragma once
// A whole run over a divided scene.

#include <vector>

#include <nlohmann/json.hpp>

#include "harness/thesis/cluster/run.hpp"
#include "harness/thesis/cluster/split/light_run.hpp"
#include "harness/thesis/cluster/split/part_member.hpp"
#include "harness/thesis/cluster/transport.hpp"

namespace beambench::cluster {

struct SplitRun {
  Job job;
  std::vector<PartReport> reports;  ///< by process
  double seconds = 0.0;             ///< wall time from the first beam to the last hit
  std::vector<LightReport> light;   ///< by process; empty if no light was requested
  double light_seconds = 0.0;       ///< wall time from the last hit to the picture
  render::RayCensus census;         ///< rays traced for the light
  std::uint64_t shading_bytes = 0;  ///< size of the whole scene, if process 0 keeps it for shading
  std::uint64_t whole_scene_bytes = 0;
  std::uint64_t whole_primitives = 0;
  std::uint64_t result_hash = 0;  ///< hash of the hits, or of the picture's light
};

/// Counterparts of `lead` and `follow` in which each process keeps only its part of the scene. Each
/// process reads the whole scene and frees it before building; process 0 keeps it, without an
/// octree, if the picture needs the surfaces hit.
SplitRun lead_split(const ClusterRequest& request, Transport& transport);
void follow_split(const Job& job, Transport& transport);

nlohmann::ordered_json to_json(const SplitRun& run);
std::string summary(const SplitRun& run);

}  // namespace beambench::cluster

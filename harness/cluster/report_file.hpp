#pragma once
// The record of a run on several processes.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/cluster/job.hpp"
#include "harness/cluster/process_report.hpp"

namespace beambench::cluster {

/// All of a run.
struct ClusterRun {
  Job job;
  std::string work;  ///< "beams" or "blocks"
  std::size_t batch = 1;
  int in_flight = 1;
  bool producer_consumes = false;
  std::vector<Introduction> introductions;  ///< by process; the producer's own is the first
  ClusterReport report;
  std::uint64_t result_hash = 0;  ///< of the hits, or of the picture's light
};

/// For people and programs: totals, and what each process did.
nlohmann::ordered_json to_json(const ClusterRun& run);

/// A row for each task in the order in which they were made, and a last one, `end`, for what the
/// producer did after the last task: what a simulation needs of them.
std::string task_table(const ClusterReport& report);

/// What to tell a person: a line or two.
std::string summary(const ClusterRun& run);

}  // namespace beambench::cluster

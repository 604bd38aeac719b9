#pragma once
// The record of a run on several processes: totals, each process, and each task.

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "harness/render/ray_census.hpp"
#include "harness/thesis/cluster/job.hpp"
#include "harness/thesis/cluster/transport.hpp"

namespace beambench::cluster {

struct Traffic {
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;

  void add(std::size_t size) {
    ++messages;
    bytes += size;
  }
  Traffic& operator+=(const Traffic& other) {
    messages += other.messages;
    bytes += other.bytes;
    return *this;
  }
};
nlohmann::ordered_json to_json(const Traffic& traffic);
nlohmann::ordered_json to_json(const render::RayCensus& census);

/// The work of a process. Wall times are those of the transport's clock.
struct ProcessReport {
  std::uint64_t tasks = 0;
  std::uint64_t samples = 0;  ///< number of samples in its results
  double busy_seconds = 0.0;  ///< wall time in tasks
  double cpu_seconds = 0.0;   ///< CPU time in tasks
  double wait_seconds = 0.0;  ///< wall time waiting for messages
  double last_result = 0.0;   ///< wall time from the beginning to its last result
  Traffic from_producer;
  Traffic to_producer;
  Bytes counted;                   ///< `TaskWorker::write_counts`
  bool final_report_came = false;  ///< whether a consumer's final report has arrived
};

/// One task, in the order of creation.
struct TaskReport {
  ProcessId process = kProducer;  ///< the process that performed it
  double walk_seconds = 0.0;      ///< CPU time of the producer since the previous task
  double work_seconds = 0.0;      ///< CPU time of the task
  double accept_seconds = 0.0;    ///< CPU time of the producer for the task's result
  double estimate_seconds = 0.0;  ///< the expected time of the task, if it was estimated
  std::size_t samples = 0;
  std::size_t task_bytes = 0;
  std::size_t result_bytes = 0;
};

struct ClusterReport {
  double seconds = 0.0;            ///< wall time from the first beam to the last result
  double walk_seconds = 0.0;       ///< CPU time in which the producer made tasks
  double last_walk_seconds = 0.0;  ///< the part of `walk_seconds` after the last task
  double accept_seconds = 0.0;     ///< CPU time in which the producer collected results
  double producer_wait_seconds = 0.0;
  std::vector<ProcessReport> processes;  ///< by `ProcessId`
  std::vector<TaskReport> tasks;
  std::vector<std::string> remarks;  ///< failures from which the run recovered, one sentence each
  std::vector<ProcessId> lost;       ///< processes that did not respond at the end

  /// Returns the messages of all processes in one direction.
  Traffic total(Traffic ProcessReport::*direction) const {
    Traffic sum;
    for (const ProcessReport& process : processes) sum += process.*direction;
    return sum;
  }
  /// Returns the share of the run during which the producer did not wait for a message.
  double producer_busy_share() const {
    return seconds > 0.0 ? 1.0 - producer_wait_seconds / seconds : 1.0;
  }
};

/// The complete record of a run.
struct ClusterRun {
  Job job;
  std::string work;  ///< `name_of(Work)`
  std::size_t batch = 1;
  int in_flight = 1;
  bool producer_consumes = false;
  bool stored = false;                     ///< processes kept their results until the end
  std::size_t resumed_tasks = 0;           ///< tasks of an interrupted run that were not repeated
  double pre_pass_seconds = 0.0;           ///< CPU time of the producer, before the first task
  std::vector<ReadyReport> ready_reports;  ///< by process; the producer's own is the first
  ClusterReport report;
  std::uint64_t result_hash = 0;  ///< hash of the hits, or of the picture's light
};

/// Returns totals, and the report of each process.
nlohmann::ordered_json to_json(const ClusterRun& run);

/// Returns a row for each task in order, and a last row, `end`, for the producer's time after the
/// last task: the input of a simulation.
std::string task_table(const ClusterReport& report);

/// Returns one or two lines for the user.
std::string summary(const ClusterRun& run);

}  // namespace beambench::cluster

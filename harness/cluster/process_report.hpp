#pragma once
// What a run took, process by process and task by task.

#include <cstdint>
#include <string>
#include <vector>

#include "harness/cluster/transport.hpp"

namespace beambench::cluster {

struct Traffic {
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;

  void add(std::size_t size) {
    ++messages;
    bytes += size;
  }
};

/// What a process did. Wall seconds are those of the transport's clock.
struct ProcessReport {
  std::uint64_t tasks = 0;
  std::uint64_t samples = 0;  ///< in its results
  double busy_seconds = 0.0;  ///< wall time in tasks
  double cpu_seconds = 0.0;   ///< processor time in tasks
  double wait_seconds = 0.0;  ///< wall time waiting for messages
  double last_result = 0.0;   ///< wall time from the beginning to its last result
  Traffic from_producer;
  Traffic to_producer;
  Bytes counted;               ///< `TaskWorker::tell`
  bool said_farewell = false;  ///< of a consumer: it came to its end
};

/// One task, in the order in which they were made.
struct TaskReport {
  ProcessId process = kProducer;  ///< who did it
  double walk_seconds = 0.0;      ///< processor time of the producer since the task before
  double work_seconds = 0.0;      ///< processor time of the task
  double accept_seconds = 0.0;    ///< processor time of the producer for its result
  std::size_t samples = 0;
  std::size_t task_bytes = 0;
  std::size_t result_bytes = 0;
};

struct ClusterReport {
  double seconds = 0.0;            ///< wall time from the first beam to the last result
  double walk_seconds = 0.0;       ///< processor time in which the producer made tasks
  double last_walk_seconds = 0.0;  ///< of it: after the last task
  double accept_seconds = 0.0;     ///< processor time in which it put results together
  double producer_wait_seconds = 0.0;
  std::vector<ProcessReport> processes;  ///< by `ProcessId`
  std::vector<TaskReport> tasks;
  std::vector<std::string> remarks;  ///< what went wrong and was mended, a sentence each
  std::vector<ProcessId> lost;       ///< processes that hung at the end

  /// The part of the run in which the producer did not wait for a message.
  double producer_busy_share() const {
    return seconds > 0.0 ? 1.0 - producer_wait_seconds / seconds : 1.0;
  }
};

}  // namespace beambench::cluster

#pragma once
// What the tasks of a picture cost, as a run of the real program recorded it.

#include <cstddef>
#include <filesystem>
#include <vector>

namespace beambench::cluster {

/// One task: seconds of the processor, bytes of its messages.
struct TaskCost {
  double walk_seconds;    ///< of the producer, since the task before
  double work_seconds;    ///< of who does it
  double accept_seconds;  ///< of the producer, for its result
  std::size_t task_bytes;
  std::size_t result_bytes;
  std::size_t samples;
};

struct TaskCosts {
  std::vector<TaskCost> tasks;     ///< in the order in which they were made
  double last_walk_seconds = 0.0;  ///< of the producer, behind the last task

  double walk_seconds() const;    ///< of all tasks, and behind them
  double work_seconds() const;    ///< of all tasks
  double accept_seconds() const;  ///< of all tasks
};

/// Reads what `beambench-cluster --tasks FILE.csv` wrote. Throws InputError naming file and line.
TaskCosts read_task_costs(const std::filesystem::path& path);

/// So many times as slow machines: of the producer's walk, and of all other work.
TaskCosts slowed(TaskCosts costs, double walk, double work);

/// Results of so many bytes a sample, whatever was recorded: what another program would send.
TaskCosts with_results_of(double bytes_a_sample, TaskCosts costs);

}  // namespace beambench::cluster

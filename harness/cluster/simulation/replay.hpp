#pragma once
// The recorded costs of a picture's tasks, and producer and consumers that replay them: they take
// the time and send the bytes that the real ones did, and know nothing of scene or octree.

#include <cstddef>
#include <filesystem>
#include <utility>
#include <vector>

#include "harness/cluster/roles.hpp"
#include "harness/cluster/simulation/charged_transport.hpp"

namespace beambench::cluster {

/// One task: CPU seconds, bytes of its messages.
struct TaskCost {
  double walk_seconds;    ///< of the producer, since the task before
  double work_seconds;    ///< of its process
  double accept_seconds;  ///< of the producer, for its result
  std::size_t task_bytes;
  std::size_t result_bytes;
  std::size_t samples;
};

struct TaskCosts {
  std::vector<TaskCost> tasks;     ///< in the order in which they were made
  double last_walk_seconds = 0.0;  ///< of the producer, after the last task

  double walk_seconds() const;    ///< of all tasks, and after them
  double work_seconds() const;    ///< of all tasks
  double accept_seconds() const;  ///< of all tasks
};

/// Reads a file of `beambench-cluster --tasks FILE.csv`. Throws InputError naming file and line.
TaskCosts read_task_costs(const std::filesystem::path& path);

/// Scales the times: of the producer's traversal, and of all other work.
TaskCosts slowed(TaskCosts costs, double walk, double work);

/// Sets the size of results to this many bytes per sample, as another program would send.
TaskCosts with_results_of(double bytes_per_sample, TaskCosts costs);

/// Makes the recorded tasks in their order. A task is its number, padded to the recorded size.
class ReplayedSource : public TaskSource {
 public:
  ReplayedSource(const TaskCosts& costs, Spend spend) : costs_(&costs), spend_(std::move(spend)) {}
  bool next(Bytes& task) override;

 private:
  const TaskCosts* costs_;
  Spend spend_;
  std::size_t made_ = 0;
};

/// Spends the recorded time on a task. A result is the task's number, padded to the recorded size.
class ReplayedWorker : public TaskWorker {
 public:
  ReplayedWorker(const TaskCosts& costs, Spend spend) : costs_(&costs), spend_(std::move(spend)) {}
  void perform(std::span<const std::byte> task, Bytes& result, const Heartbeat& heartbeat) override;

 private:
  const TaskCosts* costs_;
  Spend spend_;
};

/// Spends the recorded time on a result. Throws ProtocolError for one that comes twice.
class ReplayedSink : public ResultSink {
 public:
  ReplayedSink(const TaskCosts& costs, Spend spend)
      : costs_(&costs), spend_(std::move(spend)), came_(costs.tasks.size(), false) {}
  std::size_t accept(std::span<const std::byte> result) override;

 private:
  const TaskCosts* costs_;
  Spend spend_;
  std::vector<bool> came_;
};

}  // namespace beambench::cluster

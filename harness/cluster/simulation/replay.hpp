#pragma once
// The roles of producer and consumers played from a record: they take the time and send the bytes
// that the real ones did, and know nothing of scene or octree.

#include <utility>
#include <vector>

#include "harness/cluster/roles.hpp"
#include "harness/cluster/simulation/spend.hpp"
#include "harness/cluster/simulation/task_costs.hpp"

namespace beambench::cluster {

/// Makes the recorded tasks in their order. A task is its number and as many bytes as it had.
class ReplayedSource : public TaskSource {
 public:
  ReplayedSource(const TaskCosts& costs, Spend spend) : costs_(&costs), spend_(std::move(spend)) {}
  bool next(Bytes& task) override;

 private:
  const TaskCosts* costs_;
  Spend spend_;
  std::size_t made_ = 0;
};

/// Takes as long for a task as it took. A result is the task's number and as many bytes as it had.
class ReplayedWorker : public TaskWorker {
 public:
  ReplayedWorker(const TaskCosts& costs, Spend spend) : costs_(&costs), spend_(std::move(spend)) {}
  void perform(std::span<const std::byte> task, Bytes& result, const Pulse& pulse) override;

 private:
  const TaskCosts* costs_;
  Spend spend_;
};

/// Takes as long for a result as it took. Throws ProtocolError for one that comes twice.
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

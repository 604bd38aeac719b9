#include "harness/cluster/simulation/replay.hpp"

#include <algorithm>

namespace beambench::cluster {
namespace {

using Number = std::uint32_t;

/// The number of a task in as many bytes as the real message had, or in its own four.
void put(Number number, std::size_t size, Bytes& bytes) {
  const std::size_t begin = bytes.size();
  ByteWriter(bytes).put(number);
  bytes.resize(begin + std::max(size, sizeof number));
}

Number number_in(std::span<const std::byte> bytes, const TaskCosts& costs) {
  const auto number = ByteReader(bytes).get<Number>();
  if (number >= costs.tasks.size()) throw ProtocolError("a message tells of a task that is none");
  return number;
}

}  // namespace

bool ReplayedSource::next(Bytes& task) {
  if (made_ == costs_->tasks.size()) {
    spend_(costs_->last_walk_seconds);
    return false;
  }
  const TaskCost& cost = costs_->tasks[made_];
  spend_(cost.walk_seconds);
  put(static_cast<Number>(made_++), cost.task_bytes, task);
  return true;
}

void ReplayedWorker::perform(std::span<const std::byte> task, Bytes& result, const Pulse&) {
  const Number number = number_in(task, *costs_);
  const TaskCost& cost = costs_->tasks[number];
  spend_(cost.work_seconds);
  put(number, cost.result_bytes, result);
}

std::size_t ReplayedSink::accept(std::span<const std::byte> result) {
  const Number number = number_in(result, *costs_);
  if (came_[number]) throw ProtocolError("a result came twice");
  came_[number] = true;
  spend_(costs_->tasks[number].accept_seconds);
  return costs_->tasks[number].samples;
}

}  // namespace beambench::cluster

#pragma once
// The recorded costs of a picture's tasks, and their replay: a transport whose messages cost CPU
// time, and a producer and consumers that take as much time and send as many bytes as in the
// recorded run, but need neither scene nor octree.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "harness/thesis/cluster/image_division.hpp"
#include "harness/thesis/cluster/transport.hpp"

namespace beambench::cluster {

/// Lets seconds of the (simulated) CPU pass.
using Spend = std::function<void(double seconds)>;

/// The CPU time of messages, in addition to the network's time.
struct MessageCost {
  double message_seconds;  ///< for each message, sent or received
  double byte_seconds;     ///< for each byte of a message
  double look_seconds;     ///< for polling without a message
};

/// A transport that charges CPU time for messages.
class ChargedTransport : public Transport {
 public:
  ChargedTransport(Transport& carrier, const MessageCost& cost, Spend spend)
      : carrier_(&carrier), cost_(cost), spend_(std::move(spend)) {}

  ProcessId self() const override { return carrier_->self(); }
  int processes() const override { return carrier_->processes(); }
  double seconds() const override { return carrier_->seconds(); }

  void send(ProcessId to, Tag tag, Bytes bytes) override {
    charge(bytes);
    carrier_->send(to, tag, std::move(bytes));
  }
  void flush() override { carrier_->flush(); }
  std::optional<Message> poll() override {
    auto message = carrier_->poll();
    if (message) {
      charge(message->bytes);
    } else {
      spend_(cost_.look_seconds);
    }
    return message;
  }
  std::optional<Message> wait(double seconds) override {
    auto message = carrier_->wait(seconds);
    if (message) charge(message->bytes);
    return message;
  }
  void broadcast(Bytes& bytes) override {
    charge(bytes);
    carrier_->broadcast(bytes);
  }

 private:
  void charge(const Bytes& bytes) {
    spend_(cost_.message_seconds + cost_.byte_seconds * static_cast<double>(bytes.size()));
  }

  Transport* carrier_;
  MessageCost cost_;
  Spend spend_;
};

/// One task: its CPU seconds, and the bytes of its messages.
struct TaskCost {
  double walk_seconds;    ///< of the producer, since the previous task
  double work_seconds;    ///< of its process
  double accept_seconds;  ///< of the producer, for its result
  std::size_t task_bytes;
  std::size_t result_bytes;
  std::size_t samples;
  double estimate_seconds = 0.0;  ///< the expected time of the task, if recorded
};

struct TaskCosts {
  std::vector<TaskCost> tasks;     ///< in the order of creation
  double last_walk_seconds = 0.0;  ///< of the producer, after the last task

  double walk_seconds() const;    ///< of all tasks, including the time after the last one
  double work_seconds() const;    ///< of all tasks
  double accept_seconds() const;  ///< of all tasks
};

/// Reads a file of `beambench-cluster --tasks FILE.csv`. Throws InputError with file and line.
TaskCosts read_task_costs(const std::filesystem::path& path);

/// Multiplies the times of the producer's traversal by `walk`, and all other times by `work`.
TaskCosts slowed(TaskCosts costs, double walk, double work);

/// Sets the size of results to this many bytes per sample, as sent by another program.
TaskCosts with_results_of(double bytes_per_sample, TaskCosts costs);

/// Returns the messages for that many consumers, as lists of recorded tasks. Throws InputError for
/// kEqualCost if no estimates were recorded.
std::vector<Share> planned(ImageDivision division, const TaskCosts& costs, int consumers);

/// Merges each share into one task, like the tiles of a range. If `stored`, results stay with the
/// consumer, which returns a single receipt for the whole share.
TaskCosts merged(const TaskCosts& costs, const std::vector<Share>& shares, bool stored);

/// Makes the recorded tasks, in order or as planned. A task is its number, padded to the recorded
/// size.
class ReplayedSource : public TaskSource {
 public:
  /// Spends `before` seconds before the first task. `plan` is empty if the tasks are not planned.
  ReplayedSource(const TaskCosts& costs, Spend spend, std::vector<Share> plan = {},
                 double before = 0.0)
      : costs_(&costs), spend_(std::move(spend)), plan_(std::move(plan)), before_(before) {}
  bool next(Bytes& task) override;
  std::size_t parcel_size() const override;

 private:
  std::optional<std::size_t> next_number();

  const TaskCosts* costs_;
  Spend spend_;
  std::vector<Share> plan_;
  double before_;
  std::size_t made_ = 0;
  std::size_t share_ = 0;
  std::size_t place_ = 0;  ///< position in the share
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

/// Spends the recorded time on a result. Throws ProtocolError for duplicates.
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

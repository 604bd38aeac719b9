#pragma once
// The process that makes the tasks, distributes them and collects the results.

#include <deque>
#include <functional>
#include <map>
#include <span>

#include "harness/thesis/cluster/messages.hpp"
#include "harness/thesis/cluster/report.hpp"
#include "harness/thesis/cluster/transport.hpp"
#include "harness/thesis/cluster/worker_pool.hpp"

namespace beambench::cluster {

/// The defaults are those of the thesis.
struct ProducerOptions {
  std::size_t batch = 1;          ///< tasks per message
  int in_flight = 1;              ///< messages that a consumer may hold
  bool consumes = false;          ///< the producer performs tasks while no consumer waits
  double timeout = 30.0;          ///< seconds after which a silent consumer is declared lost
  double startup_timeout = 60.0;  ///< seconds to wait for a first consumer before starting alone
  /// Called once with each task and its result; may be empty.
  std::function<void(std::span<const std::byte> task, std::span<const std::byte> result)> keep;
};

/// The producer of section 6.2. It takes a task from its source and sends it to the consumer that
/// has waited longest, without waiting until the message has left. Before each message it receives
/// the results that have arrived. When there are no more tasks, each consumer is shut down after
/// its last result.
///
/// A consumer that is silent for too long is declared lost: its tasks go to the other consumers, or
/// are performed by the producer if no consumer is left. If it responds again, it receives work
/// again. Of duplicate results, only the first is used.
class Producer {
 public:
  /// Checks a consumer's ready report; throws InputError if it does not match, which ends the run.
  using Check = std::function<void(ProcessId, std::span<const std::byte>)>;

  /// All arguments must outlive this object. `own` performs the tasks that no consumer receives.
  Producer(Transport& transport, TaskSource& source, ResultSink& sink, TaskWorker& own, Check check,
           const ProducerOptions& options);

  /// Runs all tasks, from the first to the last result. If an exception is thrown, the consumers
  /// have been shut down.
  ClusterReport run();

 private:
  struct Parcel {
    Bytes bytes;
    std::size_t first_task;
    ProcessId holder;
  };
  using Number = std::uint32_t;

  void finish();
  void wait_for_final_reports();
  bool make_parcel();
  void hand_out(Number number);
  void give(Number number, ProcessId consumer);
  void give_lost();
  void do_here(Number number);
  bool must_work_alone() const;

  void wait_for_message();
  void handle(const Message& message);
  void take_results(const Message& message);
  void take_result(std::size_t number, std::span<const std::byte> task, ProcessId from,
                   const ParcelItem& result);
  void declare_silent_lost();
  void shut_down(ProcessId consumer);
  void shut_down_idle();
  void shut_down_all();

  ProcessReport& of(ProcessId process) {
    return report_.processes[static_cast<std::size_t>(process)];
  }

  Transport* transport_;
  TaskSource* source_;
  ResultSink* sink_;
  TaskWorker* own_;
  Check check_;
  ProducerOptions options_;
  WorkerPool pool_;
  std::map<Number, Parcel> open_;  ///< parcels without results
  std::deque<Number> lost_;        ///< parcels of `open_` that no process is working on
  Number next_number_ = 0;
  double begin_ = 0.0;
  double walked_ = 0.0;  ///< CPU seconds since the previous task
  ClusterReport report_;
};

}  // namespace beambench::cluster

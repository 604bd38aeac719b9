#pragma once
// The process that makes the work, gives it away and puts the results together.

#include <deque>
#include <functional>
#include <map>
#include <span>

#include "harness/cluster/crew.hpp"
#include "harness/cluster/parcel.hpp"
#include "harness/cluster/process_report.hpp"
#include "harness/cluster/roles.hpp"
#include "harness/cluster/transport.hpp"

namespace beambench::cluster {

/// As in the thesis unless told otherwise.
struct ProducerOptions {
  std::size_t batch = 1;   ///< tasks in a message
  int in_flight = 1;       ///< messages that a consumer may have at a time
  bool consumes = false;   ///< does a task itself when no consumer waits
  double timeout = 30.0;   ///< seconds after which a silent consumer is given up
  double patience = 60.0;  ///< seconds after which it begins alone where no consumer is ready
};

/// The producer of section 6.2: takes a task from its source, gives it to the consumer that has
/// waited longest without waiting for the message to leave, and looks for results before each
/// message it sends, whoever they come from. When there are no more tasks each consumer is sent
/// home with its last result.
///
/// A consumer that is silent for too long is given up: what it had goes to the others, or is done
/// here where nobody is left. Should it be heard again it is given work again; whatever comes twice
/// is used once.
class Producer {
 public:
  /// Is told what a consumer says of itself when it is ready; throws InputError when that does not
  /// fit this run, which ends the run.
  using Check = std::function<void(ProcessId, std::span<const std::byte>)>;

  /// All that is given must outlive this. `own` does what is not given away.
  Producer(Transport& transport, TaskSource& source, ResultSink& sink, TaskWorker& own, Check check,
           const ProducerOptions& options);

  /// All tasks, from the first to the last result. Whatever it throws, the consumers were sent home
  /// before.
  ClusterReport run();

 private:
  struct Parcel {
    Bytes bytes;
    std::size_t first_task;
    ProcessId holder;
  };
  using Number = std::uint32_t;

  void produce();
  void finish();
  void take_leave();
  bool make_parcel();
  void hand_out(Number number);
  void give(Number number, ProcessId consumer);
  void give_lost();
  void do_here(Number number);
  bool must_work_alone() const;

  void take_in_what_came();
  void wait_for_message();
  void handle(const Message& message);
  void take_results(const Message& message);
  void take_result(std::size_t task, ProcessId from, const ParcelItem& result);
  void take_farewell(const Message& message);
  void give_up_silent();
  void dismiss(ProcessId consumer);
  void dismiss_idle();
  void dismiss_all();

  ProcessReport& of(ProcessId process) {
    return report_.processes[static_cast<std::size_t>(process)];
  }

  Transport* transport_;
  TaskSource* source_;
  ResultSink* sink_;
  TaskWorker* own_;
  Check check_;
  ProducerOptions options_;
  Crew crew_;
  std::map<Number, Parcel> open_;  ///< parcels without results
  std::deque<Number> lost_;        ///< of these: those that nobody is doing
  Number next_number_ = 0;
  double begin_ = 0.0;
  double walked_ = 0.0;  ///< CPU seconds since the task before
  ClusterReport report_;
};

}  // namespace beambench::cluster

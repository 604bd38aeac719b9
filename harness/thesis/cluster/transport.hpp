#pragma once
// Messages between processes, and the roles in a run: task sources, workers, result sinks.

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>

#include "harness/thesis/cluster/messages.hpp"

namespace beambench::cluster {

/// The kind of a message.
enum class Tag {
  kReady,        ///< consumer: its octree is built; contains its identity
  kTasks,        ///< producer: a parcel of work
  kResults,      ///< consumer: results of a parcel
  kHeartbeat,    ///< consumer: it is still working on a long task
  kEnd,          ///< producer: no more work
  kFinalReport,  ///< consumer: its report and, for a divided scene, its hits
  // For a divided scene (split/):
  kGo,      ///< process 0: all processes have the same scene; begin
  kCross,   ///< to any process: beams and rays that enter its part
  kAsk,     ///< process 0: request for a kCount when idle
  kCount,   ///< to process 0: the numbers of kCross messages sent and received
  kLight,   ///< to any process: rays of light that enter its part
  kAnswers  ///< to process 0: the results of rays of light
};

/// The rank of a process; 0 is the producer.
using ProcessId = int;
inline constexpr ProcessId kProducer = 0;

struct Message {
  ProcessId from;
  Tag tag;
  Bytes bytes;
};

/// The base of interfaces with several implementations; used by reference only.
class Role {
 public:
  Role() = default;
  Role(const Role&) = delete;
  Role& operator=(const Role&) = delete;
  virtual ~Role() = default;
};

/// Sends and receives the messages of a process. Messages from one process may overtake each other.
class Transport : public Role {
 public:
  static constexpr double kForever = std::numeric_limits<double>::infinity();

  virtual ProcessId self() const = 0;
  virtual int processes() const = 0;
  virtual double seconds() const = 0;  ///< wall time

  /// Sends a message without waiting for its receiver.
  virtual void send(ProcessId to, Tag tag, Bytes bytes) = 0;
  /// Waits until all messages have left.
  virtual void flush() = 0;
  /// Returns a message that has arrived, if any.
  virtual std::optional<Message> poll() = 0;
  /// Returns the next message; nothing if none arrives within `seconds`.
  virtual std::optional<Message> wait(double seconds) = 0;
  /// Sends the producer's bytes to all processes; every process must call it.
  virtual void broadcast(Bytes& bytes) = 0;
};

/// Makes the producer's tasks.
class TaskSource : public Role {
 public:
  /// Appends the next task to a message; returns false when there are no more.
  virtual bool next(Bytes& task) = 0;
  /// Returns the number of tasks of the next message if the source determines it; otherwise 0.
  virtual std::size_t parcel_size() const { return 0; }
  /// Returns the estimated time of the last task in seconds; 0 if it was not estimated.
  virtual double estimate() const { return 0.0; }
};

/// Called from time to time during a long task.
using Heartbeat = std::function<void()>;

/// Performs tasks.
class TaskWorker : public Role {
 public:
  /// Performs a task and appends its result to a message. The same task yields the same bytes on
  /// every process. Throws ProtocolError for bytes that are not a task.
  virtual void perform(std::span<const std::byte> task, Bytes& result,
                       const Heartbeat& heartbeat) = 0;
  /// Appends the worker's counts, for the report.
  virtual void write_counts(Bytes&) const {}
};

/// Collects results.
class ResultSink : public Role {
 public:
  /// Accepts a result and returns the number of its samples. Results come in any order, each once.
  /// Throws ProtocolError for bytes that are not a result.
  virtual std::size_t accept(std::span<const std::byte> result) = 0;
};

}  // namespace beambench::cluster

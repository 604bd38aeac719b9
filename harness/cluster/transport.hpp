#pragma once
// Messages between processes.

#include <limits>
#include <optional>

#include "harness/cluster/messages.hpp"

namespace beambench::cluster {

/// What a message is.
enum class Tag {
  kReady,        ///< consumer: its octree is built; its identity
  kTasks,        ///< producer: a parcel of work
  kResults,      ///< consumer: results of a parcel
  kHeartbeat,    ///< consumer: it is working on a long task
  kEnd,          ///< producer: there is no more work
  kFinalReport,  ///< consumer: its report; of a divided scene, with its hits
  // Of a divided scene (split/):
  kGo,     ///< process 0: all have the same scene; begin
  kCross,  ///< to any process: beams and rays that enter its part
  kAsk,    ///< process 0: request for a kCount when idle
  kCount   ///< the numbers of kCross messages sent and received
};

/// The rank of a process; 0 is the producer.
using ProcessId = int;
inline constexpr ProcessId kProducer = 0;

struct Message {
  ProcessId from;
  Tag tag;
  Bytes bytes;
};

/// Sends and receives the messages of a process. Messages of one process may overtake each other.
class Transport {
 public:
  static constexpr double kForever = std::numeric_limits<double>::infinity();

  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  virtual ProcessId self() const = 0;
  virtual int processes() const = 0;
  virtual double seconds() const = 0;  ///< wall time

  /// Sends a message without waiting for its receiver.
  virtual void send(ProcessId to, Tag tag, Bytes bytes) = 0;
  /// Waits until all messages have left.
  virtual void flush() = 0;
  /// A message that has arrived, if any.
  virtual std::optional<Message> poll() = 0;
  /// The next message; nothing if none arrives within `seconds`.
  virtual std::optional<Message> wait(double seconds) = 0;
  /// Sends the producer's bytes to all; every process calls it.
  virtual void broadcast(Bytes& bytes) = 0;
};

}  // namespace beambench::cluster

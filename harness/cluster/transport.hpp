#pragma once
// How messages get from one process to another.

#include <limits>
#include <optional>

#include "harness/cluster/bytes.hpp"

namespace beambench::cluster {

/// What a message is.
enum class Tag {
  kReady,     ///< consumer: I have built my octree, and this is what it is like
  kTasks,     ///< producer: a parcel of work
  kResults,   ///< consumer: what came of a parcel
  kAlive,     ///< consumer: I am still at it
  kEnd,       ///< producer: there is no more work
  kFarewell,  ///< consumer: what I did; of a divided scene, with what was found
  // Of a divided scene (split/):
  kGo,     ///< process 0: all have the same scene; begin
  kCross,  ///< to any process: beams and rays that come into your part
  kAsk,    ///< process 0: when you have nothing to do, tell how many of these you sent and got
  kCount   ///< that
};

/// What processes call themselves among each other: 0 is the producer.
using ProcessId = int;
inline constexpr ProcessId kProducer = 0;

struct Message {
  ProcessId from;
  Tag tag;
  Bytes bytes;
};

/// A process's post office. Messages of one process may overtake each other.
class Transport {
 public:
  static constexpr double kForever = std::numeric_limits<double>::infinity();

  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  virtual ProcessId self() const = 0;
  virtual int processes() const = 0;
  /// A clock.
  virtual double seconds() const = 0;

  /// Puts a message on its way and does not wait for it to be taken.
  virtual void send(ProcessId to, Tag tag, Bytes bytes) = 0;
  /// Waits until all that was sent has left.
  virtual void flush() = 0;
  /// A message that has come, if any.
  virtual std::optional<Message> poll() = 0;
  /// The next message; nothing where none comes within `seconds`.
  virtual std::optional<Message> wait(double seconds) = 0;
  /// Gives the producer's bytes to all; everybody calls it.
  virtual void broadcast(Bytes& bytes) = 0;
};

}  // namespace beambench::cluster

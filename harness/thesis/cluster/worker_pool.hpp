#pragma once
// The states of the consumers: waiting, working or silent.

#include <cstdint>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "harness/thesis/cluster/transport.hpp"

namespace beambench::cluster {

/// Selects the consumer for the next parcel: among those with the fewest parcels, the one that has
/// waited longest (the thesis's round robin, section 6.2.3, in which each consumer holds at most
/// one parcel).
class WorkerPool {
 public:
  /// Consumers are 1 ... `processes` - 1. Each may hold up to `in_flight` parcels, and is declared
  /// lost if it holds one and is silent for longer than `timeout`.
  WorkerPool(int processes, int in_flight, double timeout);

  /// Records that a consumer is ready.
  void join(ProcessId consumer, double now);
  /// Records that a consumer sent something; if it was lost, it is present again.
  void heard(ProcessId consumer, double now);
  /// Record that a consumer was sent a parcel, or that its results arrived.
  void gave(ProcessId consumer, double now);
  void returned(ProcessId consumer, double now);
  /// Records that a consumer was sent the end message.
  void shut_down(ProcessId consumer);

  std::optional<ProcessId> longest_waiting() const;
  bool nobody_present() const { return present_count_ == 0; }
  /// Declares silent consumers that hold parcels lost, and returns them.
  std::vector<ProcessId> declare_silent_lost(double now);
  /// Returns the time at which the next consumer will have been silent for too long.
  double next_deadline() const;

  /// Returns the consumers that joined and are neither lost nor shut down.
  std::vector<ProcessId> present() const;
  bool idle(ProcessId consumer) const { return at(consumer).load == 0; }
  /// Returns the consumers that were declared lost and have not been heard from since.
  std::vector<ProcessId> lost() const;
  std::vector<ProcessId> not_shut_down() const;

 private:
  enum class State { kAbsent, kPresent, kLost, kShutDown };
  struct Member {
    State state = State::kAbsent;
    int load = 0;
    std::uint64_t since = 0;  ///< the turn at which it began to wait
    double last_heard = 0.0;
  };
  /// The key of a consumer, ordered by the sequence in which work is assigned.
  struct Place {
    int load;
    std::uint64_t since;
    ProcessId consumer;
    bool operator<(const Place& other) const {
      return std::tie(load, since, consumer) < std::tie(other.load, other.since, other.consumer);
    }
  };

  Member& at(ProcessId consumer) { return members_[static_cast<std::size_t>(consumer)]; }
  const Member& at(ProcessId consumer) const {
    return members_[static_cast<std::size_t>(consumer)];
  }
  void become(Member& member, State state);
  void leave_queue(ProcessId consumer);
  void enter_queue(ProcessId consumer);
  /// Returns the consumers whose state is `wanted`.
  template <class Wanted>
  std::vector<ProcessId> consumers(Wanted wanted) const;

  int in_flight_;
  double timeout_;
  std::uint64_t turn_ = 0;
  int present_count_ = 0;
  std::vector<Member> members_;
  std::set<Place> waiting_;
};

}  // namespace beambench::cluster

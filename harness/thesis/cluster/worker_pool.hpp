#pragma once
// The state of the consumers: waiting, working, silent.

#include <cstdint>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "harness/thesis/cluster/transport.hpp"

namespace beambench::cluster {

/// Selects the consumer for the next parcel: of those with the fewest parcels the one that has
/// waited longest (the thesis's round robin, section 6.2.3, where each has one at most).
class WorkerPool {
 public:
  /// Consumers are 1 ... `processes` - 1. Each may hold up to `in_flight` parcels and is declared
  /// lost when it holds one and was silent for longer than `timeout`.
  WorkerPool(int processes, int in_flight, double timeout);

  /// A consumer is ready.
  void join(ProcessId consumer, double now);
  /// A consumer sent something; if it was lost, it is back.
  void heard(ProcessId consumer, double now);
  /// It was sent a parcel, or its results came.
  void gave(ProcessId consumer, double now);
  void returned(ProcessId consumer, double now);
  /// It was sent the end.
  void shut_down(ProcessId consumer);

  std::optional<ProcessId> longest_waiting() const;
  bool nobody_present() const { return present_count_ == 0; }
  /// Declares consumers lost that hold parcels and are silent; returns them.
  std::vector<ProcessId> declare_silent_lost(double now);
  /// When the next one will have been silent for too long.
  double next_deadline() const;

  /// Those that joined and are neither lost nor shut down.
  std::vector<ProcessId> present() const;
  bool idle(ProcessId consumer) const { return at(consumer).load == 0; }
  /// Those that were declared lost and not heard since.
  std::vector<ProcessId> lost() const;
  std::vector<ProcessId> not_shut_down() const;

 private:
  enum class State { kAbsent, kPresent, kLost, kShutDown };
  struct Member {
    State state = State::kAbsent;
    int load = 0;
    std::uint64_t since = 0;  ///< the turn since which it waits
    double last_heard = 0.0;
  };
  /// Ordered by who is given work next.
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
  /// Those whose state is `wanted`.
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

#pragma once
// The consumers as the producer sees them: who waits, who works, who is silent.

#include <cstdint>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "harness/cluster/transport.hpp"

namespace beambench::cluster {

/// Whom to give the next parcel to: of the consumers with the fewest parcels the one that has
/// waited longest (the thesis's round robin, section 6.2.3, where each has one at most).
class Crew {
 public:
  /// Consumers are 1 ... `processes` - 1. Each may hold up to `in_flight` parcels and is given up
  /// when it holds one and was silent for longer than `timeout`.
  Crew(int processes, int in_flight, double timeout);

  /// A consumer is there and waits.
  void join(ProcessId consumer, double now);
  /// A consumer gave a sign of life; one that was given up is back.
  void heard(ProcessId consumer, double now);
  /// It was sent a parcel, or its results came.
  void gave(ProcessId consumer, double now);
  void returned(ProcessId consumer, double now);
  /// It was told that there is no more work.
  void dismiss(ProcessId consumer);

  std::optional<ProcessId> longest_waiting() const;
  bool nobody_present() const { return present_count_ == 0; }
  /// Gives consumers up that hold parcels and are silent; tells who they are.
  std::vector<ProcessId> give_up_silent(double now);
  /// When the next one will have been silent for too long, should nobody be heard.
  double next_deadline() const;

  /// Those that joined, were not given up and not dismissed.
  std::vector<ProcessId> present() const;
  bool idle(ProcessId consumer) const { return at(consumer).load == 0; }
  /// Those that were given up and not heard since.
  std::vector<ProcessId> lost() const;
  std::vector<ProcessId> not_dismissed() const;

 private:
  enum class State { kAbsent, kPresent, kLost, kDismissed };
  struct Member {
    State state = State::kAbsent;
    int load = 0;
    std::uint64_t since = 0;  ///< the turn in which it began to wait
    double last_heard = 0.0;
  };
  /// In the order in which they are given work.
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

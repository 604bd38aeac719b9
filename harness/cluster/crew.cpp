#include "harness/cluster/crew.hpp"

#include <algorithm>

namespace beambench::cluster {

Crew::Crew(int processes, int in_flight, double timeout)
    : in_flight_(in_flight), timeout_(timeout), members_(static_cast<std::size_t>(processes)) {}

void Crew::join(ProcessId consumer, double now) {
  Member& member = at(consumer);
  if (member.state == State::kDismissed) return;
  become(member, State::kPresent);
  member.last_heard = now;
  leave_queue(consumer);
  member.since = turn_++;
  enter_queue(consumer);
}

void Crew::heard(ProcessId consumer, double now) {
  at(consumer).last_heard = now;
  if (at(consumer).state == State::kLost) join(consumer, now);
}

void Crew::gave(ProcessId consumer, double now) {
  leave_queue(consumer);
  Member& member = at(consumer);
  if (member.load == 0) member.last_heard = now;  // nothing was expected of it before
  ++member.load;
  enter_queue(consumer);
}

void Crew::returned(ProcessId consumer, double now) {
  leave_queue(consumer);
  Member& member = at(consumer);
  --member.load;
  member.since = turn_++;
  heard(consumer, now);
  enter_queue(consumer);
}

void Crew::dismiss(ProcessId consumer) {
  leave_queue(consumer);
  become(at(consumer), State::kDismissed);
}

std::optional<ProcessId> Crew::longest_waiting() const {
  if (waiting_.empty()) return std::nullopt;
  return waiting_.begin()->consumer;
}

std::vector<ProcessId> Crew::give_up_silent(double now) {
  std::vector<ProcessId> silent;
  if (timeout_ == Transport::kForever) return silent;
  for (const ProcessId consumer : present()) {
    Member& member = at(consumer);
    if (member.load == 0 || now - member.last_heard <= timeout_) continue;
    leave_queue(consumer);
    become(member, State::kLost);
    silent.push_back(consumer);
  }
  return silent;
}

double Crew::next_deadline() const {
  double deadline = Transport::kForever;
  if (timeout_ == deadline) return deadline;
  for (const Member& member : members_) {
    if (member.state == State::kPresent && member.load > 0) {
      deadline = std::min(deadline, member.last_heard + timeout_);
    }
  }
  return deadline;
}

template <class Wanted>
std::vector<ProcessId> Crew::consumers(Wanted wanted) const {
  std::vector<ProcessId> found;
  for (std::size_t i = kProducer + 1; i < members_.size(); ++i) {
    if (wanted(members_[i].state)) found.push_back(static_cast<ProcessId>(i));
  }
  return found;
}

std::vector<ProcessId> Crew::present() const {
  return consumers([](State state) { return state == State::kPresent; });
}

std::vector<ProcessId> Crew::lost() const {
  return consumers([](State state) { return state == State::kLost; });
}

std::vector<ProcessId> Crew::not_dismissed() const {
  return consumers([](State state) { return state != State::kDismissed; });
}

void Crew::become(Member& member, State state) {
  if (member.state == State::kPresent) --present_count_;
  if (state == State::kPresent) ++present_count_;
  member.state = state;
}

void Crew::leave_queue(ProcessId consumer) {
  waiting_.erase({at(consumer).load, at(consumer).since, consumer});
}

void Crew::enter_queue(ProcessId consumer) {
  const Member& member = at(consumer);
  if (member.state != State::kPresent || member.load >= in_flight_) return;
  waiting_.insert({member.load, member.since, consumer});
}

}  // namespace beambench::cluster

#include "harness/thesis/cluster/worker_pool.hpp"

#include <algorithm>

namespace beambench::cluster {

WorkerPool::WorkerPool(int processes, int in_flight, double timeout)
    : in_flight_(in_flight), timeout_(timeout), members_(static_cast<std::size_t>(processes)) {}

void WorkerPool::join(ProcessId consumer, double now) {
  Member& member = at(consumer);
  if (member.state == State::kShutDown) return;
  become(member, State::kPresent);
  member.last_heard = now;
  leave_queue(consumer);
  member.since = turn_++;
  enter_queue(consumer);
}

void WorkerPool::heard(ProcessId consumer, double now) {
  at(consumer).last_heard = now;
  if (at(consumer).state == State::kLost) join(consumer, now);
}

void WorkerPool::gave(ProcessId consumer, double now) {
  leave_queue(consumer);
  Member& member = at(consumer);
  if (member.load == 0) member.last_heard = now;  // it had no work before
  ++member.load;
  enter_queue(consumer);
}

void WorkerPool::returned(ProcessId consumer, double now) {
  leave_queue(consumer);
  Member& member = at(consumer);
  --member.load;
  member.since = turn_++;
  heard(consumer, now);
  enter_queue(consumer);
}

void WorkerPool::shut_down(ProcessId consumer) {
  leave_queue(consumer);
  become(at(consumer), State::kShutDown);
}

std::optional<ProcessId> WorkerPool::longest_waiting() const {
  if (waiting_.empty()) return std::nullopt;
  return waiting_.begin()->consumer;
}

std::vector<ProcessId> WorkerPool::declare_silent_lost(double now) {
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

double WorkerPool::next_deadline() const {
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
std::vector<ProcessId> WorkerPool::consumers(Wanted wanted) const {
  std::vector<ProcessId> found;
  for (std::size_t i = kProducer + 1; i < members_.size(); ++i) {
    if (wanted(members_[i].state)) found.push_back(static_cast<ProcessId>(i));
  }
  return found;
}

std::vector<ProcessId> WorkerPool::present() const {
  return consumers([](State state) { return state == State::kPresent; });
}

std::vector<ProcessId> WorkerPool::lost() const {
  return consumers([](State state) { return state == State::kLost; });
}

std::vector<ProcessId> WorkerPool::not_shut_down() const {
  return consumers([](State state) { return state != State::kShutDown; });
}

void WorkerPool::become(Member& member, State state) {
  if (member.state == State::kPresent) --present_count_;
  if (state == State::kPresent) ++present_count_;
  member.state = state;
}

void WorkerPool::leave_queue(ProcessId consumer) {
  waiting_.erase({at(consumer).load, at(consumer).since, consumer});
}

void WorkerPool::enter_queue(ProcessId consumer) {
  const Member& member = at(consumer);
  if (member.state != State::kPresent || member.load >= in_flight_) return;
  waiting_.insert({member.load, member.since, consumer});
}

}  // namespace beambench::cluster

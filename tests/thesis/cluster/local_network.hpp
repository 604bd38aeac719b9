#pragma once
// Threads that act as processes, with delayed messages.

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "harness/thesis/cluster/transport.hpp"

namespace beambench::cluster {

/// Delivers each message after its own random delay, so that messages overtake each other.
class LocalNetwork {
 public:
  LocalNetwork(int processes, unsigned seed, double longest_delay)
      : random_(seed), longest_delay_(longest_delay) {
    for (int i = 0; i < processes; ++i) ends_.push_back(std::make_unique<End>(*this, i));
  }

  Transport& at(ProcessId process) { return *ends_[static_cast<std::size_t>(process)]; }

  /// Loses all messages from `process` after the next `count`.
  void mute_after(ProcessId process, int count) {
    const std::lock_guard lock(mutex_);
    left_[process] = count;
  }

 private:
  using Clock = std::chrono::steady_clock;
  using Seconds = std::chrono::duration<double>;

  class End : public Transport {
   public:
    End(LocalNetwork& network, ProcessId self) : network_(&network), self_(self) {}

    ProcessId self() const override { return self_; }
    int processes() const override { return static_cast<int>(network_->ends_.size()); }
    double seconds() const override { return Seconds(Clock::now().time_since_epoch()).count(); }
    void flush() override {}
    void send(ProcessId to, Tag tag, Bytes bytes) override {
      network_->post(to, {self_, tag, std::move(bytes)});
    }
    std::optional<Message> poll() override { return wait(0.0); }
    std::optional<Message> wait(double seconds) override {
      std::unique_lock lock(network_->mutex_);
      const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                               Seconds(std::min(seconds, 1e6)));
      while (true) {
        const auto now = Clock::now();
        if (!box_.empty() && box_.begin()->first <= now) {
          Message message = std::move(box_.begin()->second);
          box_.erase(box_.begin());
          return message;
        }
        if (now >= deadline) return std::nullopt;
        auto until = deadline;
        if (!box_.empty()) until = std::min(until, box_.begin()->first);
        network_->changed_.wait_until(lock, until);
      }
    }
    void broadcast(Bytes& bytes) override {
      std::unique_lock lock(network_->mutex_);
      if (self_ == kProducer) {
        network_->broadcast_ = bytes;
        network_->changed_.notify_all();
      } else {
        network_->changed_.wait(lock, [&] { return network_->broadcast_.has_value(); });
        bytes = *network_->broadcast_;
      }
    }

   private:
    friend class LocalNetwork;
    LocalNetwork* network_;
    ProcessId self_;
    std::multimap<Clock::time_point, Message> box_;  ///< by arrival time
  };

  void post(ProcessId to, Message message) {
    const std::lock_guard lock(mutex_);
    if (const auto found = left_.find(message.from); found != left_.end() && found->second-- <= 0) {
      return;
    }
    const Seconds delay(std::uniform_real_distribution<>(0.0, longest_delay_)(random_));
    ends_[static_cast<std::size_t>(to)]->box_.emplace(
        Clock::now() + std::chrono::duration_cast<Clock::duration>(delay), std::move(message));
    changed_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::mt19937 random_;
  double longest_delay_;
  std::vector<std::unique_ptr<End>> ends_;
  std::map<ProcessId, int> left_;
  std::optional<Bytes> broadcast_;
};

}  // namespace beambench::cluster

#include "harness/thesis/cluster/split/light_exchange.hpp"

#include <stdexcept>
#include <utility>

namespace beambench::cluster {

std::vector<accel::Hit> LightExchange::nearest_hits(std::vector<LightRay> rays) {
  if (rays.empty()) return {};
  Round round{std::vector<accel::Hit>(rays.size()), rays.size()};
  std::unique_lock lock(mutex_);
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i].number = number(round, i);
  leaving_.insert(leaving_.end(), rays.begin(), rays.end());
  left_.notify_one();
  answered_.wait(lock, [&] { return closed_ || round.missing == 0; });
  if (round.missing > 0) throw std::runtime_error("the rays of a picture have no results");
  return std::move(round.hits);
}

/// Assigns a number to the ray at a place in a round, and returns the number. The caller must hold
/// the lock.
std::uint32_t LightExchange::number(Round& round, std::size_t place) {
  if (free_.empty()) {
    free_.push_back(static_cast<std::uint32_t>(waiting_.size()));
    waiting_.emplace_back();
  }
  const std::uint32_t number = free_.back();
  free_.pop_back();
  waiting_[number] = {&round, place};
  return number;
}

std::vector<LightRay> LightExchange::take(std::chrono::microseconds moment) {
  std::unique_lock lock(mutex_);
  left_.wait_for(lock, moment, [&] { return !leaving_.empty(); });
  return std::exchange(leaving_, {});
}

void LightExchange::answer(const LightAnswer& answer) {
  const std::lock_guard lock(mutex_);
  if (answer.number >= waiting_.size() || waiting_[answer.number].round == nullptr) {
    throw ProtocolError("a result for a ray of light that is not waiting for one");
  }
  const auto [round, place] = std::exchange(waiting_[answer.number], {});
  free_.push_back(answer.number);
  round->hits[place] = answer.hit;
  if (--round->missing == 0) answered_.notify_all();
}

void LightExchange::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  waiting_.clear();  // lets the waiting threads leave
  answered_.notify_all();
}

}  // namespace beambench::cluster

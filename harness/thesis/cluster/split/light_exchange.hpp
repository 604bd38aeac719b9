#pragma once
// Between the threads that draw and the one that sends and receives.

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "harness/thesis/cluster/split/light_ray.hpp"

namespace beambench::cluster {

/// Threads that draw leave batches of rays here and wait; one thread takes them, has them traced in
/// all processes, and returns what they found. Only that thread knows the transport.
class LightExchange {
 public:
  /// Waits until all rays are answered; returns their hits. Gives each ray its number. Throws
  /// std::runtime_error once the exchange is closed.
  std::vector<accel::Hit> nearest_hits(std::vector<LightRay> rays);

  /// The rays that were left since the last call. Waits a moment for some.
  std::vector<LightRay> take(std::chrono::microseconds moment);
  /// Throws ProtocolError unless the ray waits for it.
  void answer(const LightAnswer& answer);
  /// No ray will be answered any more.
  void close();

 private:
  /// A batch that a thread waits for.
  struct Round {
    std::vector<accel::Hit> hits;
    std::size_t missing;
  };
  /// For whom the ray with some number is traced.
  struct Waiting {
    Round* round = nullptr;  ///< null: the number is free
    std::size_t place = 0;
  };
  std::uint32_t number(Round& round, std::size_t place);

  std::mutex mutex_;
  std::condition_variable left_;
  std::condition_variable answered_;
  std::vector<LightRay> leaving_;
  std::vector<Waiting> waiting_;  ///< by number
  std::vector<std::uint32_t> free_;
  bool closed_ = false;
};

}  // namespace beambench::cluster

#pragma once
// Connects the drawing threads with the thread that sends and receives.

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "harness/thesis/cluster/split/light_ray.hpp"

namespace beambench::cluster {

/// Drawing threads submit batches of rays here and wait. A single thread takes the rays, has them
/// traced in all processes, and returns their hits. Only this thread uses the transport.
class LightExchange {
 public:
  /// Waits until all rays have been traced, and returns their hits. Assigns each ray its number.
  /// Throws std::runtime_error once the exchange is closed.
  std::vector<accel::Hit> nearest_hits(std::vector<LightRay> rays);

  /// Returns the rays submitted since the last call; if there are none, waits up to `moment`.
  std::vector<LightRay> take(std::chrono::microseconds moment);
  /// Delivers a result. Throws ProtocolError unless the ray is waiting for it.
  void answer(const LightAnswer& answer);
  /// Closes the exchange: no more rays will be traced.
  void close();

 private:
  /// A batch for which a thread waits.
  struct Round {
    std::vector<accel::Hit> hits;
    std::size_t missing;
  };
  /// The recipient of the result for the ray with a given number.
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

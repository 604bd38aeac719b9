#pragma once
// Rays of light between processes: the data transmitted for a shadow, mirror or refracted ray, and
// the messages that contain them.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "accel/core/ray.hpp"
#include "harness/thesis/cluster/messages.hpp"
#include "harness/thesis/cluster/report.hpp"
#include "harness/thesis/cluster/split/scene_split.hpp"
#include "harness/thesis/cluster/transport.hpp"

namespace beambench::cluster {

enum class LightQuery : std::uint8_t { kClosest, kAny };

/// A ray that enters another process's cell. The ray itself is sent, because only process 0 has the
/// hit from which it starts.
struct LightRay {
  std::uint32_t cell;
  std::uint32_t number;  ///< number assigned by process 0
  LightQuery query;
  accel::Ray ray;
  double t;         ///< the t at which it enters
  accel::Hit best;  ///< the best hit so far, in the whole scene
};

/// The result of a ray: the closest hit in the whole scene, or whether the ray hits anything.
struct LightAnswer {
  std::uint32_t number;
  accel::Hit hit;
};

void write_light(const LightRay& ray, Bytes& bytes);
void write_light(const LightAnswer& answer, Bytes& bytes);
/// Reads a whole message. Throws ProtocolError for other bytes.
std::vector<LightRay> read_light_rays(std::span<const std::byte> bytes);
std::vector<LightAnswer> read_light_answers(std::span<const std::byte> bytes);

/// Collects rays and results into messages, with one open message for each process.
class LightOutbox {
 public:
  LightOutbox(Transport& transport, const SceneSplit& split);
  void hand_over(const LightRay& ray);
  void answer(const LightAnswer& answer);

  /// The size above which it pays to send a message early, so that its recipient can begin while
  /// this process still works.
  static constexpr std::size_t kLarge = 1 << 12;
  /// Sends the messages of at least `least` bytes; by default, all nonempty ones.
  void send(std::size_t least = 1);

  std::uint64_t rays() const { return rays_; }
  std::uint64_t answers() const { return answers_; }
  const Traffic& sent() const { return sent_; }

 private:
  void send(ProcessId to, Tag tag, Bytes& open, std::size_t least);

  Transport* transport_;
  const SceneSplit* split_;
  std::vector<Bytes> open_rays_;  ///< by process
  Bytes open_answers_;            ///< to process 0
  std::uint64_t rays_ = 0;
  std::uint64_t answers_ = 0;
  Traffic sent_;
};

}  // namespace beambench::cluster

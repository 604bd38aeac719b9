#pragma once
// Rays of light between processes: what is sent of a shadow, mirror or refracted ray, and the
// messages it travels in.

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

/// A ray that enters another process's cell. It is sent itself: only process 0 knows from which
/// hit it comes.
struct LightRay {
  std::uint32_t cell;
  std::uint32_t number;  ///< by which process 0 knows it
  LightQuery query;
  accel::Ray ray;
  double t;         ///< where it enters
  accel::Hit best;  ///< so far, in the whole scene
};

/// What a ray has found: the closest hit in the whole scene, or whether there is any.
struct LightAnswer {
  std::uint32_t number;
  accel::Hit hit;
};

void write_light(const LightRay& ray, Bytes& bytes);
void write_light(const LightAnswer& answer, Bytes& bytes);
/// All of a message. Throws ProtocolError for other bytes.
std::vector<LightRay> read_light_rays(std::span<const std::byte> bytes);
std::vector<LightAnswer> read_light_answers(std::span<const std::byte> bytes);

/// Collects rays and answers into messages, one open message for each process.
class LightOutbox {
 public:
  LightOutbox(Transport& transport, const SceneSplit& split);
  void hand_over(const LightRay& ray);
  void answer(const LightAnswer& answer);

  /// Makes a message worth sending early: while a process works on, others can begin.
  static constexpr std::size_t kLarge = 1 << 12;
  /// Sends the messages of at least that many bytes, by default all that are not empty.
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

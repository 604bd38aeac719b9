#pragma once
// Beams and rays that cross the border between two processes' parts of a scene.

#include <cstdint>
#include <variant>

#include "accel/beam/beam.hpp"
#include "harness/cluster/messages.hpp"

namespace beambench::cluster {

/// A beam that enters another process's cell by a face. Its `node`, `corner` and `size` mean
/// nothing there.
struct BeamHandoff {
  std::uint32_t cell;
  accel::beam::Crossing face;
  accel::beam::Beam beam;
};

/// A ray that enters another process's cell, with its best hit so far.
struct RayHandoff {
  std::uint32_t cell;
  std::uint32_t sample;      ///< its place in the hit buffer
  double t;                  ///< where it enters
  float best_t;              ///< infinity: none
  scenes::PrimitiveId best;  ///< in the whole scene
};

using Handoff = std::variant<BeamHandoff, RayHandoff>;

void write_handoff(const BeamHandoff& beam, Bytes& bytes);
void write_handoff(const RayHandoff& ray, Bytes& bytes);

/// The next one in a message. Throws ProtocolError for other bytes.
Handoff read_handoff(ByteReader& reader, const accel::beam::EyeView& view);

/// Receives what leaves a process's part.
class HandoffSink {
 public:
  HandoffSink() = default;
  HandoffSink(const HandoffSink&) = delete;
  HandoffSink& operator=(const HandoffSink&) = delete;
  virtual ~HandoffSink() = default;
  virtual void hand_over(const BeamHandoff& beam) = 0;
  virtual void hand_over(const RayHandoff& ray) = 0;
};

}  // namespace beambench::cluster

#pragma once
// What crosses the border between two processes' parts of a scene.

#include <cstdint>
#include <variant>

#include "accel/beam/beam.hpp"
#include "harness/cluster/bytes.hpp"

namespace beambench::cluster {

/// A beam that enters another process's cell by a face. Its `node`, `corner` and `size` mean
/// nothing there.
struct CrossingBeam {
  std::uint32_t cell;
  accel::beam::Crossing face;
  accel::beam::Beam beam;
};

/// A ray that enters another process's cell, and the best that it found before.
struct CrossingRay {
  std::uint32_t cell;
  std::uint32_t sample;      ///< its place in the hit buffer
  double t;                  ///< where it enters
  float best_t;              ///< infinity: nothing found
  scenes::PrimitiveId best;  ///< in the whole scene
};

using Traveler = std::variant<CrossingBeam, CrossingRay>;

void write_traveler(const CrossingBeam& beam, Bytes& bytes);
void write_traveler(const CrossingRay& ray, Bytes& bytes);

/// The next of them in a message. Throws ProtocolError for what is neither.
Traveler read_traveler(ByteReader& reader, const accel::beam::EyeView& view);

}  // namespace beambench::cluster

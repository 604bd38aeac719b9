#pragma once
// With which others a ray is traced, in a structure that divides its beams into blocks of rays; for
// pictures.

#include <cstdint>

namespace beambench::accel {

/// Where a ray of an image or of a pencil is among the beams of a structure.
struct BeamPlace {
  enum class Way : std::uint8_t {
    kSingle,      ///< in no beam
    kBackground,  ///< in a beam that meets no leaf, so that no ray is needed
    kInOrder,     ///< in a block of neighbors in the picture
    kRegrouped,  ///< in a block put together anew: of rays that the pencil's apex sees side by side
    kHandedOver  ///< in a block, and through a part of the structure as a single ray
  };
  static constexpr int kSides = 6;

  Way way = Way::kSingle;
  /// The side of the cube about a pencil's apex that the ray passes: +x, -x, +y, -y, +z, -z.
  std::uint8_t side = 0;
  std::uint32_t beam = 0;   ///< a tile of the image, or a part of a pencil
  std::uint32_t block = 0;  ///< each number is used in one beam only

  friend bool operator==(const BeamPlace&, const BeamPlace&) = default;
};

}  // namespace beambench::accel

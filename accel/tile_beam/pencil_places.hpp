#pragma once
// Shows the places of a unit's rays, for pictures.

#include <bit>
#include <cstdint>
#include <span>

#include "accel/core/beam_place.hpp"
#include "accel/tile_beam/hand_over.hpp"
#include "accel/tile_beam/pencil_unit.hpp"

namespace beambench::accel::tile_beam {

/// Each side of the cube has its own blocks.
inline constexpr std::uint32_t kBlocksOfPart = CubeSide::kCount * PencilUnit::kBlocks;

/// Records the places of the rays traced by a walk through one side of the cube, indexed by the
/// rays' numbers in the unit. Blocks are numbered from 0 to `kBlocksOfPart`.
inline void note_places(const PencilUnit& unit, CubeSide side, const HandOverRecorder& recorder,
                        std::span<BeamPlace> places) {
  for (std::size_t place = 0; place < unit.places; ++place) {
    const std::size_t block = unit.slot[place];
    const auto usual =
        block < PencilUnit::kListed ? BeamPlace::Way::kInOrder : BeamPlace::Way::kRegrouped;
    for (std::uint32_t left = unit.lanes[block]; left != 0; left &= left - 1) {
      const std::size_t at =
          block * PencilUnit::kBlock + static_cast<std::size_t>(std::countr_zero(left));
      places[unit.ray_at(at)] = {
          recorder.is_handed_over[at] ? BeamPlace::Way::kHandedOver : usual,
          static_cast<std::uint8_t>(side.number), 0,
          static_cast<std::uint32_t>(static_cast<std::size_t>(side.number) * PencilUnit::kBlocks +
                                     block)};
    }
  }
}

}  // namespace beambench::accel::tile_beam

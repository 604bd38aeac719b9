#pragma once
// Draws beams over a picture, for structures that divide beams into blocks of rays.

#include <cstdint>
#include <span>
#include <vector>

#include "accel/core/beam_place.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/picture/legend.hpp"

namespace beambench::render {

/// The places of rays, and the sample of a picture to which each belongs.
struct PlacedRays {
  std::span<const accel::BeamPlace> places;
  std::span<const std::uint32_t> samples;  ///< as numbered by a HitBuffer
  int per_pixel;
};

/// Dims the picture and draws the tiles of its primary rays: outlines and, within them, the blocks
/// as a mesh, in a color that shows how the rays are traced. A pixel shows its first sample.
/// Returns the meaning of the colors.
std::vector<LegendEntry> overlay_tiles(Image& image, const PlacedRays& rays);

/// Draws a pencil of other rays in the same way: its parts and their blocks, in a color for each
/// side of the cube about the apex.
std::vector<LegendEntry> overlay_pencil(Image& image, const PlacedRays& rays);

}  // namespace beambench::render

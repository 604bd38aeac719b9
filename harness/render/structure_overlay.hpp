#pragma once
// Draws the parts of a structure, or how it traces, over a picture: its beams, cells or pencils.

#include <span>
#include <string_view>
#include <vector>

#include "accel/core/registry.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/picture/legend.hpp"

namespace beambench::render {

enum class Overlay {
  kBeams,   ///< `Inspector::beams`, or `places` of the image's rays
  kCells,   ///< `Inspector::occupied_cells`
  kPencils  ///< `Inspector::places` of a light's shadow rays
};

/// The names after --overlay, in the order of `Overlay`.
std::span<const std::string_view> overlay_names();

struct OverlayChoice {
  Overlay overlay;
  std::size_t light = 1;  ///< the light whose pencil is drawn; the scene's first is 1
};

/// Parses `beams` or `pencils:light=2`. Throws InputError listing the valid names or parameters, or
/// the structures that have such an overlay if this one does not. Support is determined by a trial
/// over a small scene, not by name.
OverlayChoice parse_overlay(std::string_view text, const accel::StructureInfo& structure);

/// Throws InputError if the scene does not have that light.
void require_light(const OverlayChoice& choice, const scenes::Scene& scene);

/// Draws over the picture of an image that has been traced, so a grid filled on demand shows the
/// cells that the rays filled. Returns the legend.
std::vector<LegendEntry> draw_overlay(const OverlayChoice& choice, Image& picture,
                                      const accel::Accelerator& accelerator,
                                      const scenes::Scene& scene, const accel::PrimaryRays& rays);

}  // namespace beambench::render

#pragma once
// What a structure can draw over a picture: its beams, its cells.

#include <span>
#include <string>
#include <string_view>

#include "accel/core/registry.hpp"
#include "harness/render/picture/category_map.hpp"

namespace beambench::cli {

enum class Overlay {
  kBeams,  ///< `Accelerator::beam_outlines`
  kCells   ///< `Accelerator::occupied_cells`
};

/// The names after --overlay, in the order of `Overlay`.
std::span<const std::string_view> overlay_names();
/// Throws InputError listing the valid names, or naming the structures that show such a thing when
/// this one does not. Who does is found by asking each over a small scene, not by its name.
Overlay parse_overlay(std::string_view name, const accel::StructureInfo& structure);

/// Draws over the picture that `rays` show, once they have been asked for: a grid that is filled by
/// rays shows what they filled. Returns the legend.
std::vector<render::LegendEntry> draw_overlay(Overlay overlay, render::Image& image,
                                              const accel::Accelerator& accelerator,
                                              const accel::PrimaryRays& rays);

}  // namespace beambench::cli

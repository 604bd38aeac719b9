#include "harness/cli/overlay_picture.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/render/picture/overlay.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/core/error.hpp"

namespace beambench::cli {
namespace {

constexpr std::array<std::string_view, 2> kNames{"beams", "cells"};

/// Does a structure have what the overlay draws? Asked over a scene where any that has it shows it.
bool shows(const accel::StructureInfo& structure, Overlay overlay) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=1");
  const accel::PrimaryRays rays(scene.cameras.front(), 8, 8, 1);
  const auto accelerator = accel::registry().choose({structure.name, {}}).build(scene);
  if (overlay == Overlay::kBeams) return !accelerator->beam_outlines(rays).empty();
  accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
  accelerator->trace(rays, hits, nullptr);  // cells may be made where rays come by
  return !accelerator->occupied_cells().empty();
}

}  // namespace

std::span<const std::string_view> overlay_names() { return kNames; }

Overlay parse_overlay(std::string_view name, const accel::StructureInfo& structure) {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) {
    throw InputError(
        fmt::format("unknown overlay '{}'; choose from: {}", name, fmt::join(kNames, ", ")));
  }
  const auto overlay = static_cast<Overlay>(found - kNames.begin());
  if (shows(structure, overlay)) return overlay;
  std::vector<std::string> able;
  for (const accel::StructureInfo& info : accel::registry().structures()) {
    if (shows(info, overlay)) able.push_back(info.name);
  }
  throw InputError(fmt::format("{} has no {} to draw with --overlay; structures that have: {}",
                               structure.name, name, fmt::join(able, ", ")));
}

std::vector<render::LegendEntry> draw_overlay(Overlay overlay, render::Image& image,
                                              const accel::Accelerator& accelerator,
                                              const accel::PrimaryRays& rays) {
  return overlay == Overlay::kBeams
             ? render::overlay_beams(image, accelerator.beam_outlines(rays))
             : render::overlay_cells(image, rays, accelerator.occupied_cells());
}

}  // namespace beambench::cli

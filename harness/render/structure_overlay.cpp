#include "harness/render/structure_overlay.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "accel/core/inspector_of.hpp"
#include "harness/base/messages.hpp"
#include "harness/render/light_pencil.hpp"
#include "harness/render/picture/overlay.hpp"
#include "harness/render/picture/place_overlay.hpp"
#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"

namespace beambench::render {
namespace {

constexpr std::array<std::string_view, 3> kOverlayNames{"beams", "cells", "pencils"};

std::vector<ParameterInfo> parameters_of(Overlay overlay) {
  if (overlay != Overlay::kPencils) return {};
  constexpr int kMaxLights = 1'000'000;
  return {integer_parameter("light", 1, 1, kMaxLights,
                            "the light whose shadow rays are drawn; the first is 1")};
}

/// Returns whether a structure supports the overlay, by a trial over a scene that would show it.
bool shows(const accel::StructureInfo& structure, Overlay overlay) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=1");
  const accel::PrimaryRays rays(scene.cameras.front(), 8, 8, 1);
  const auto accelerator = accel::registry().choose({structure.name, {}}).build(scene);
  const accel::Inspector& inspector = accel::inspector_of(*accelerator);
  switch (overlay) {
    case Overlay::kBeams:
      return inspector.beams(rays).has_value() || !inspector.places(rays).empty();
    case Overlay::kCells: {
      accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
      accelerator->closest_hits(rays, hits, {});  // cells may be created on demand
      return !inspector.occupied_cells().empty();
    }
    case Overlay::kPencils: {
      const accel::Ray ray = rays.ray(0, 0, 0);
      return !inspector.places(accel::RayBatch{{&ray, 1}}).empty();
    }
  }
  return false;
}

std::vector<LegendEntry> draw_beams(Image& picture, const accel::Accelerator& accelerator,
                                    const accel::PrimaryRays& rays) {
  const accel::Inspector& inspector = accel::inspector_of(accelerator);
  const std::vector<accel::BeamPlace> places = inspector.places(rays);
  if (places.empty()) {
    return overlay_beams(picture,
                         inspector.beams(rays).value_or(std::vector<accel::BeamOutline>()));
  }
  std::vector<std::uint32_t> samples(places.size());
  std::iota(samples.begin(), samples.end(), 0U);
  return overlay_tiles(picture, {places, samples, rays.samples()});
}

std::vector<LegendEntry> draw_pencil(Image& picture, const accel::Accelerator& accelerator,
                                     const scenes::Scene& scene, const accel::PrimaryRays& rays,
                                     const scenes::Light& light) {
  const LightPencil pencil = light_pencil(accelerator, scene, rays, light);
  return overlay_pencil(picture, {pencil.places, pencil.samples, rays.samples()});
}

}  // namespace

std::span<const std::string_view> overlay_names() { return kOverlayNames; }

OverlayChoice parse_overlay(std::string_view text, const accel::StructureInfo& structure) {
  const Spec spec = parse_spec(text);
  const auto overlay =
      static_cast<Overlay>(base::place_of_name("overlay", spec.name, kOverlayNames));
  const Parameters parameters(spec.name, parameters_of(overlay), spec.parameters);
  if (shows(structure, overlay)) {
    OverlayChoice choice{overlay};
    if (overlay == Overlay::kPencils) {
      choice.light = static_cast<std::size_t>(parameters.integer("light"));
    }
    return choice;
  }
  std::vector<std::string> able;
  for (const accel::StructureInfo& info : accel::registry().structures()) {
    if (shows(info, overlay)) able.push_back(info.name);
  }
  throw InputError(fmt::format("{} has no {} to draw with --overlay; structures that have: {}",
                               structure.name, spec.name, fmt::join(able, ", ")));
}

void require_light(const OverlayChoice& choice, const scenes::Scene& scene) {
  if (choice.overlay != Overlay::kPencils || choice.light <= scene.lights.size()) return;
  if (scene.lights.empty()) {
    throw InputError(fmt::format(
        "scene '{}' has no lights, so it has no pencils of shadow rays to draw with --overlay; add "
        "an 'l' line to its file",
        scene.name));
  }
  throw InputError(
      fmt::format("scene '{}' has no light {} to draw with --overlay; light is 1 ... {}",
                  scene.name, choice.light, scene.lights.size()));
}

std::vector<LegendEntry> draw_overlay(const OverlayChoice& choice, Image& picture,
                                      const accel::Accelerator& accelerator,
                                      const scenes::Scene& scene, const accel::PrimaryRays& rays) {
  switch (choice.overlay) {
    case Overlay::kBeams:
      return draw_beams(picture, accelerator, rays);
    case Overlay::kCells: {
      std::vector<accel::Box> boxes;
      for (const accel::Cell& cell : accel::inspector_of(accelerator).occupied_cells()) {
        boxes.push_back(cell.box);
      }
      return overlay_cells(picture, rays, boxes);
    }
    case Overlay::kPencils:
      return draw_pencil(picture, accelerator, scene, rays, scene.lights[choice.light - 1]);
  }
  return {};
}

}  // namespace beambench::render

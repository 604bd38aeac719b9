#include "harness/render/picture/place_overlay.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <unordered_set>

#include <fmt/format.h>
#include <glm/common.hpp>

namespace beambench::render {
namespace {

using accel::BeamPlace;
using Way = BeamPlace::Way;

/// The color strength of ordinary pixels, and of pixels where a block begins: the latter form a
/// mesh if blocks have more than one pixel.
constexpr float kPlaceTint = 0.35F;
constexpr float kMeshTint = 0.15F;

constexpr glm::vec3 kWhite(1.0F);
const glm::vec3& kBorder = okabe_ito::kYellow;  // NOLINT(cert-err58-cpp): only a reference

const glm::vec3& color_of_side(std::size_t side) {
  static const std::array<const glm::vec3*, BeamPlace::kSides> kColors{
      &okabe_ito::kSkyBlue,     &okabe_ito::kBlue,   &okabe_ito::kYellow,
      &okabe_ito::kBluishGreen, &okabe_ito::kOrange, &okabe_ito::kReddishPurple};
  return *kColors[side];
}

const glm::vec3& color_of(Way way, std::size_t side = 0) {
  switch (way) {
    case Way::kSingle:
      return kInk;
    case Way::kBackground:
      return okabe_ito::kBluishGreen;
    case Way::kInOrder:
      return color_of_side(side);
    case Way::kRegrouped:
      return kWhite;
    case Way::kHandedOver:
      return okabe_ito::kVermillion;
  }
  return kInk;
}

bool is_in_beam(const BeamPlace* place) { return place != nullptr && place->way != Way::kSingle; }

/// The first place of each pixel.
class PixelPlaces {
 public:
  PixelPlaces(const Image& image, const PlacedRays& rays)
      : width_(image.width()), first_(image.pixels().size(), nullptr) {
    for (std::size_t i = 0; i < rays.places.size(); ++i) {
      const std::size_t pixel = rays.samples[i] / static_cast<std::uint32_t>(rays.per_pixel);
      if (first_[pixel] == nullptr) first_[pixel] = &rays.places[i];
    }
  }

  /// Returns null for a pixel without a place, or outside the image.
  const BeamPlace* at(int x, int y) const {
    if (x < 0 || y < 0) return nullptr;
    return first_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                  static_cast<std::size_t>(x)];
  }
  /// Returns whether the pixel to the left or above lies in another beam or block.
  bool begins(int x, int y, std::uint32_t BeamPlace::*what) const {
    const auto differs = [&](const BeamPlace* other) {
      return is_in_beam(other) && other->*what != at(x, y)->*what;
    };
    return differs(at(x - 1, y)) || differs(at(x, y - 1));
  }

 private:
  int width_;
  std::vector<const BeamPlace*> first_;
};

void draw(Image& image, const PlacedRays& rays) {
  dim(image);
  const PixelPlaces places(image, rays);
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const BeamPlace* place = places.at(x, y);
      if (place == nullptr) continue;
      glm::vec3& pixel = image.at(x, y);
      if (is_in_beam(place) && places.begins(x, y, &BeamPlace::beam)) {
        pixel = kBorder;
      } else if (place->way == Way::kInOrder || place->way == Way::kBackground) {
        const bool is_mesh = places.begins(x, y, &BeamPlace::block);
        pixel =
            glm::mix(pixel, color_of(place->way, place->side), is_mesh ? kMeshTint : kPlaceTint);
      } else {
        pixel = color_of(place->way);
      }
    }
  }
}

LegendEntry entry_of_beams(const char* name, const PlacedRays& rays) {
  std::unordered_set<std::uint32_t> beams;
  for (const BeamPlace& place : rays.places) {
    if (is_in_beam(&place)) beams.insert(place.beam);
  }
  return {name, kBorder, beams.size()};
}

LegendEntry entry_of(const char* name, const PlacedRays& rays, Way way) {
  return {name, color_of(way),
          static_cast<std::size_t>(std::ranges::count(rays.places, way, &BeamPlace::way))};
}

}  // namespace

std::vector<LegendEntry> overlay_tiles(Image& image, const PlacedRays& rays) {
  draw(image, rays);
  return {entry_of_beams("tiles", rays), entry_of("rays in blocks", rays, Way::kInOrder),
          entry_of("passed on to single rays", rays, Way::kHandedOver),
          entry_of("background, no rays", rays, Way::kBackground)};
}

std::vector<LegendEntry> overlay_pencil(Image& image, const PlacedRays& rays) {
  constexpr std::array<const char*, BeamPlace::kSides> kSides{"+x", "-x", "+y", "-y", "+z", "-z"};
  draw(image, rays);
  std::vector<LegendEntry> legend{entry_of_beams("parts", rays)};
  for (std::size_t side = 0; side < kSides.size(); ++side) {
    const auto count = std::ranges::count_if(rays.places, [&](const BeamPlace& place) {
      return place.way == Way::kInOrder && place.side == side;
    });
    if (count == 0) continue;
    legend.push_back({fmt::format("rays in blocks, side {}", kSides[side]), color_of_side(side),
                      static_cast<std::size_t>(count)});
  }
  legend.push_back(entry_of("rays in regrouped blocks", rays, Way::kRegrouped));
  legend.push_back(entry_of("passed on to single rays", rays, Way::kHandedOver));
  legend.push_back(entry_of("rays traced singly", rays, Way::kSingle));
  return legend;
}

}  // namespace beambench::render

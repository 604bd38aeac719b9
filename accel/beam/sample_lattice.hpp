#pragma once
// The samples of an image as regular lattices, one for each position within a pixel.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"

namespace beambench::accel::beam {

/// One sample of each pixel: the samples at (x, y) + `offset`, from `begin` on, with x < width and
/// y < height. A sample's hit belongs to one place of a hit buffer, or to several when pixels share
/// it.
struct SampleLattice {
  /// The place of pixel (x - left, y - up).
  struct Place {
    int left;
    int up;
    int sample;
  };

  glm::dvec2 offset;
  int width;
  int height;
  std::vector<Place> places;
  glm::ivec2 begin{0};

  /// Calls `visit(index)` for the places in a buffer to which the sample (x, y) belongs.
  template <class Visit>
  void for_each_index(const HitSpan& buffer, int x, int y, Visit visit) const {
    for (const Place& place : places) {
      const int px = x - place.left;
      const int py = y - place.up;
      if (px < 0 || py < 0 || px >= buffer.width() || py >= buffer.height()) continue;
      visit(buffer.index(px, py, place.sample));
    }
  }
};

/// A rectangle of pixels from (left, top) on.
struct PixelRect {
  int left;
  int top;
  int width;
  int height;
};

/// Returns the samples of a part of the image. Parts that divide the image also divide its samples,
/// including those shared by pixels.
std::vector<SampleLattice> part_of(std::span<const SampleLattice> lattices, const HitSpan& buffer,
                                   const PixelRect& part);

/// Returns a lattice for each sample of a pixel. `share_corners`: samples of different pixels at
/// the same corner are one sample.
std::vector<SampleLattice> sample_lattices(const PrimaryRays& rays, bool share_corners);

}  // namespace beambench::accel::beam

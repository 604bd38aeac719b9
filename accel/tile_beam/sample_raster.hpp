#pragma once
// The samples of an image as rasters: what is drawn in one pass.

#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/hit_buffer.hpp"
#include "accel/primary_rays.hpp"

namespace beambench {

/// Samples in rows and columns of equal distance. A grid of n x n samples a pixel is one raster of
/// n times the image's size. The corners of pixels are one raster too, in which neighbouring pixels
/// share what is the same ray.
struct SampleRaster {
  /// To which pixel and sample the raster's sample (0, 0) belongs.
  struct Place {
    int left;  ///< pixel -left
    int up;
    int sample;
  };

  int width;
  int height;
  int per_pixel;              ///< samples along a pixel's side
  std::vector<Place> places;  ///< more than one where pixels share samples

  /// direction(i, j) = origin + right * i + down * j, before rounding.
  glm::dvec3 origin;
  glm::dvec3 right;
  glm::dvec3 down;

  /// The ray of a sample, with the bits that `PrimaryRays::ray` gives it.
  Ray ray(const PrimaryRays& rays, int i, int j) const {
    const int pixel_x = i / per_pixel;
    const int pixel_y = j / per_pixel;
    const glm::dvec2& offset = rays.offsets()[sample(places.front(), i, j)];
    return rays.ray_at(pixel_x + offset.x, pixel_y + offset.y);
  }

  /// Calls `visit(index)` for the places in a buffer that the sample (i, j) belongs to.
  template <class Visit>
  void for_each_index(const HitBuffer& buffer, int i, int j, Visit visit) const {
    for (const Place& place : places) {
      const int px = i / per_pixel - place.left;
      const int py = j / per_pixel - place.up;
      if (px < 0 || py < 0 || px >= buffer.width() || py >= buffer.height()) continue;
      visit(buffer.index(px, py, static_cast<int>(sample(place, i, j))));
    }
  }

 private:
  std::size_t sample(const Place& place, int i, int j) const {
    const int index = place.sample + j % per_pixel * per_pixel + i % per_pixel;
    return static_cast<std::size_t>(index);
  }
};

/// The rasters that hold all samples of an image.
std::vector<SampleRaster> sample_rasters(const PrimaryRays& rays);

}  // namespace beambench

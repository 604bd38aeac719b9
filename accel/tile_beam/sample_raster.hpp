#pragma once
// The samples of an image as rasters, each drawn in one pass.

#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/primary_rays.hpp"

namespace beambench::accel::tile_beam {

/// Samples in equidistant rows and columns. A grid of n x n samples per pixel is one raster of n
/// times the image's size. Pixel corners also form one raster, in which neighboring pixels share
/// identical rays.
struct SampleRaster {
  /// The pixel and sample to which the raster's sample (0, 0) belongs.
  struct Place {
    int left;  ///< pixel -left
    int up;
    int sample;
  };

  int width;
  int height;
  int per_pixel;              ///< samples along a pixel's side
  std::vector<Place> places;  ///< several if pixels share samples

  /// direction(i, j) = origin + right * i + down * j, before rounding.
  glm::dvec3 origin;
  glm::dvec3 right;
  glm::dvec3 down;

  /// Returns the ray of a sample, with the same bits as `PrimaryRays::ray`.
  Ray ray(const PrimaryRays& rays, int i, int j) const {
    const int pixel_x = i / per_pixel;
    const int pixel_y = j / per_pixel;
    const glm::dvec2& offset = rays.offsets()[sample(places.front(), i, j)];
    return rays.ray_at(pixel_x + offset.x, pixel_y + offset.y);
  }

  /// Calls `visit(x, index)` for the samples (left + x, j), x < width, of a row that belong to
  /// `place`; `index` is the sample's index in a buffer.
  template <class Visit>
  void for_each_of_row(const Place& place, const HitSpan& buffer, int left, int j, int width,
                       Visit visit) const {
    const int py = j / per_pixel - place.up;
    if (py < 0 || py >= buffer.height()) return;
    const int row_sample = place.sample + j % per_pixel * per_pixel;
    int px = left / per_pixel - place.left;
    int in_pixel = left % per_pixel;
    for (int x = 0; x < width; ++x) {
      if (px >= 0 && px < buffer.width()) visit(x, buffer.index(px, py, row_sample + in_pixel));
      if (++in_pixel == per_pixel) {
        in_pixel = 0;
        ++px;
      }
    }
  }

 private:
  std::size_t sample(const Place& place, int i, int j) const {
    const int index = place.sample + j % per_pixel * per_pixel + i % per_pixel;
    return static_cast<std::size_t>(index);
  }
};

/// Returns the rasters that contain all samples of an image.
std::vector<SampleRaster> sample_rasters(const PrimaryRays& rays);

}  // namespace beambench::accel::tile_beam

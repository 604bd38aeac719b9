#include "accel/tile_beam/sample_raster.hpp"

#include <cmath>

namespace beambench::accel::tile_beam {
namespace {

SampleRaster grid_of(const PrimaryRays& rays, int per_pixel, int sample) {
  const glm::dvec2 first = rays.offsets()[static_cast<std::size_t>(sample)];
  return {rays.width() * per_pixel,
          rays.height() * per_pixel,
          per_pixel,
          {{0, 0, sample}},
          rays.top_left() + rays.right() * first.x + rays.down() * first.y,
          rays.right() / static_cast<double>(per_pixel),
          rays.down() / static_cast<double>(per_pixel)};
}

}  // namespace

std::vector<SampleRaster> sample_rasters(const PrimaryRays& rays) {
  if (rays.samples() == 5) {  // corners and center
    return {{rays.width() + 1,
             rays.height() + 1,
             1,
             {{0, 0, 0}, {1, 0, 1}, {0, 1, 2}, {1, 1, 3}},
             rays.top_left(),
             rays.right(),
             rays.down()},
            grid_of(rays, 1, 4)};
  }
  const int per_pixel = static_cast<int>(std::lround(std::sqrt(rays.samples())));
  return {grid_of(rays, per_pixel, 0)};
}

}  // namespace beambench::accel::tile_beam

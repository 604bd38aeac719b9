#include "harness/render/whitted_picture.hpp"

#include <atomic>
#include <chrono>
#include <future>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

namespace beambench::render {
namespace {

/// One row, left to right: the shadow cache begins anew, so that the census is the same however
/// rows are shared among threads.
RayCensus draw_row(const Whitted& tracer, const CameraRays& rays, const accel::HitBuffer& hits,
                   int y, Image& image) {
  Whitted::Progress progress = tracer.begin();
  const double share = 1.0 / rays.samples;
  for (int x = 0; x < rays.width; ++x) {
    glm::dvec3 sum(0.0);
    for (int sample = 0; sample < rays.samples; ++sample) {
      sum += tracer.camera_ray_color(rays.ray(x, y, sample), hits.get(hits.index(x, y, sample)),
                                     progress);
    }
    image.at(x, y) = glm::vec3(share * sum);
  }
  return progress.census;
}

}  // namespace

WhittedPicture whitted_picture(const Whitted& tracer, const CameraRays& rays,
                               const accel::HitBuffer& hits, const PictureWatch& watch,
                               int threads) {
  std::optional<tbb::global_control> limit;
  if (threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
  WhittedPicture picture{Image(rays.width, rays.height), {}};
  std::vector<RayCensus> rows(static_cast<std::size_t>(rays.height));
  std::atomic<int> done = 0;
  const auto draw = [&] {
    tbb::parallel_for(0, rays.height, [&](int y) {
      rows[static_cast<std::size_t>(y)] = draw_row(tracer, rays, hits, y, picture.image);
      ++done;
    });
  };
  if (watch) {
    auto drawn = std::async(std::launch::async, draw);
    while (drawn.wait_for(std::chrono::milliseconds(100)) == std::future_status::timeout) {
      watch(static_cast<double>(done.load()) / rays.height);
    }
    drawn.get();
  } else {
    draw();
  }
  for (const RayCensus& row : rows) picture.census += row;
  return picture;
}

WhittedPicture whitted_picture_along(std::span<const std::size_t> places, const Whitted& tracer,
                                     const CameraRays& rays, const accel::HitBuffer& hits,
                                     const PictureWatch& watch) {
  constexpr std::size_t kBetweenLooks = 1 << 14;
  const auto samples = static_cast<std::size_t>(rays.samples);
  const auto width = static_cast<std::size_t>(rays.width);
  std::vector<glm::dvec3> sums(places.size() / samples, glm::dvec3(0.0));
  Whitted::Progress progress = tracer.begin();
  std::size_t done = 0;
  for (const std::size_t place : places) {
    const std::size_t pixel = place / samples;
    const accel::Ray ray =
        rays.ray(static_cast<int>(pixel % width), static_cast<int>(pixel / width),
                 static_cast<int>(place % samples));
    sums[pixel] += tracer.camera_ray_color(ray, hits.get(place), progress);
    if (++done % kBetweenLooks == 0 && watch) {
      watch(static_cast<double>(done) / static_cast<double>(places.size()));
    }
  }
  WhittedPicture picture{Image(rays.width, rays.height), progress.census};
  const double share = 1.0 / rays.samples;
  for (std::size_t pixel = 0; pixel < sums.size(); ++pixel) {
    picture.image.at(static_cast<int>(pixel % width), static_cast<int>(pixel / width)) =
        glm::vec3(share * sums[pixel]);
  }
  return picture;
}

RayCensus draw_in_order(const Whitted& tracer, const CameraRays& rays, const accel::HitBuffer& hits,
                        Image& image) {
  RayCensus census;
  for (int y = 0; y < rays.height; ++y) census += draw_row(tracer, rays, hits, y, image);
  return census;
}

}  // namespace beambench::render

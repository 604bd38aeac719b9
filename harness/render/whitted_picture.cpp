#include "harness/render/whitted_picture.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <future>
#include <numeric>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include "accel/beam/beam_tracer.hpp"
#include "harness/base/messages.hpp"
#include "scenes/core/error.hpp"

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

/// Keeps the samples of one beam after the other.
class PaintedPlaces : public accel::beam::NoBeamWatch {
 public:
  void met(accel::BeamKind, const accel::beam::Beam&) { end_beam(); }
  void painted(std::size_t place) { places_.push_back(place); }
  void finished() { end_beam(); }

  std::vector<std::size_t> take() && { return std::move(places_); }

 private:
  /// A beam finds its samples lattice by lattice, and those that hit before the others.
  void end_beam() {
    std::sort(places_.begin() + static_cast<std::ptrdiff_t>(begin_), places_.end());
    begin_ = places_.size();
  }

  std::vector<std::size_t> places_;
  std::size_t begin_ = 0;  ///< of the beam that was met last
};

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
  std::ranges::transform(sums, picture.image.pixels().begin(),
                         [share](const glm::dvec3& sum) { return glm::vec3(share * sum); });
  return picture;
}

RayCensus draw_in_order(const Whitted& tracer, const CameraRays& rays, const accel::HitBuffer& hits,
                        Image& image) {
  RayCensus census;
  for (int y = 0; y < rays.height; ++y) census += draw_row(tracer, rays, hits, y, image);
  return census;
}

ShadingOrder parse_shading_order(std::string_view name) {
  constexpr std::array<std::string_view, 3> kNames{"rows", "scan", "beams"};
  return static_cast<ShadingOrder>(base::place_of_name("order", name, kNames));
}

std::vector<std::size_t> scan_order(const accel::PrimaryRays& rays) {
  std::vector<std::size_t> places(rays.count());
  std::iota(places.begin(), places.end(), std::size_t{0});
  return places;
}

std::vector<std::size_t> beam_order(const accel::Accelerator& structure,
                                    const accel::PrimaryRays& rays) {
  const auto* tracer = dynamic_cast<const accel::beam::BeamTracer*>(&structure);
  if (tracer == nullptr) {
    throw InputError(
        "only beams have an order of their own: give --accel beam, with parameters if you like, "
        "or --order scan");
  }
  accel::HitBuffer buffer(rays.width(), rays.height(), rays.samples());
  PaintedPlaces painted;
  tracer->trace_watched(rays, buffer, painted);
  std::vector<std::size_t> places = std::move(painted).take();

  std::vector<bool> seen(buffer.size(), false);
  for (const std::size_t place : places) seen[place] = true;
  for (std::size_t place = 0; place < buffer.size(); ++place) {
    if (!seen[place]) places.push_back(place);
  }
  return places;
}

}  // namespace beambench::render

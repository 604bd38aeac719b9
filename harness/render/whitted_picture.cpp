#include "harness/render/whitted_picture.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <future>
#include <numeric>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>
#include <tbb/parallel_for.h>

#include "accel/core/inspector_of.hpp"
#include "accel/core/threads.hpp"
#include "harness/base/messages.hpp"
#include "harness/rays/picture_order.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/base/error.hpp"

namespace beambench::render {
namespace {

using rays::PixelRange;

std::vector<PixelRange> rows_of(const accel::PrimaryRays& image) {
  std::vector<PixelRange> rows;
  for (int y = 0; y < image.height(); ++y) rows.push_back({0, y, image.width(), y + 1});
  return rows;
}

/// The division into parts whose pixels are shaded together, and the order of their samples.
class Parts {
 public:
  Parts(const accel::PrimaryRays& image, const Whitted& tracer)
      : samples_(image.samples()),
        are_rows_(tracer.remembers_shadows()),
        ranges_(are_rows_ ? rows_of(image) : rays::squares_of(image, tracer.batch())) {}

  const std::vector<PixelRange>& ranges() const { return ranges_; }
  /// Calls `visit(x, y, sample)` for the samples of a range.
  template <class Visit>
  void for_each_sample(const PixelRange& range, const Visit& visit) const {
    if (!are_rows_) return rays::for_each_sample(range, samples_, visit);
    for (int x = range.left; x < range.right; ++x) {
      for (int sample = 0; sample < samples_; ++sample) visit(x, range.top, sample);
    }
  }

 private:
  int samples_;
  bool are_rows_;
  std::vector<PixelRange> ranges_;
};

/// Camera rays, their hits and their light.
struct Batch {
  std::vector<accel::Ray> rays;
  std::vector<std::uint32_t> samples;
  std::vector<std::optional<accel::Hit>> hits;
  std::vector<glm::dvec3> colors;

  void reserve(std::size_t count) {
    rays.reserve(count);
    samples.reserve(count);
    hits.reserve(count);
  }
  /// Assigns component by component, because a copy would wait until the new ray is in memory.
  void add(const accel::Ray& ray, std::size_t sample, const accel::HitBuffer& found) {
    accel::Ray& own = rays.emplace_back();
    own.origin = ray.origin;
    own.direction = ray.direction;
    samples.push_back(static_cast<std::uint32_t>(sample));
    hits.push_back(found.get(sample));
  }
  void shade(const Whitted& tracer, const accel::PrimaryRays& image, Whitted::Progress& progress) {
    colors.resize(rays.size());
    tracer.trace_light({&image, rays, samples, hits}, colors, progress);
  }
};

/// Draws a part with a separate shadow cache, so that its census does not depend on how parts are
/// shared among threads.
RayCensus draw(const Parts& parts, const PixelRange& part, const Whitted& tracer,
               const accel::PrimaryRays& rays, const accel::HitBuffer& hits, Image& image) {
  const auto width = static_cast<std::size_t>(part.width());
  const std::size_t pixels = width * static_cast<std::size_t>(part.height());
  Batch batch;
  batch.reserve(pixels * static_cast<std::size_t>(rays.samples()));
  parts.for_each_sample(part, [&](int x, int y, int sample) {
    batch.add(rays.ray(x, y, sample), hits.index(x, y, sample), hits);
  });
  Whitted::Progress progress = tracer.begin();
  batch.shade(tracer, rays, progress);
  std::vector<glm::dvec3> sums(pixels, glm::dvec3(0.0));
  auto color = batch.colors.begin();
  parts.for_each_sample(part, [&](int x, int y, int) {
    sums[static_cast<std::size_t>(y - part.top) * width +
         static_cast<std::size_t>(x - part.left)] += *color++;
  });
  const double share = 1.0 / rays.samples();
  auto sum = sums.begin();
  for (int y = part.top; y < part.bottom; ++y) {
    for (int x = part.left; x < part.right; ++x) image.at(x, y) = glm::vec3(share * *sum++);
  }
  return progress.census;
}

}  // namespace

WhittedPicture whitted_picture(const Whitted& tracer, const accel::PrimaryRays& rays,
                               const accel::HitBuffer& hits, const PictureWatch& watch,
                               int threads) {
  WhittedPicture picture{Image(rays.width(), rays.height()), {}};
  const Parts parts(rays, tracer);
  const std::vector<PixelRange>& ranges = parts.ranges();
  std::vector<RayCensus> counts(ranges.size());
  std::atomic<std::size_t> done = 0;
  const auto draw_all = [&] {
    accel::on_threads(threads, [&] {
      tbb::parallel_for(std::size_t{0}, ranges.size(), [&](std::size_t i) {
        counts[i] = draw(parts, ranges[i], tracer, rays, hits, picture.image);
        ++done;
      });
    });
  };
  if (watch) {
    auto all = std::async(std::launch::async, draw_all);
    while (all.wait_for(std::chrono::milliseconds(100)) == std::future_status::timeout) {
      watch(static_cast<double>(done.load()) / static_cast<double>(ranges.size()));
    }
    all.get();
  } else {
    draw_all();
  }
  for (const RayCensus& count : counts) picture.census += count;
  return picture;
}

WhittedPicture whitted_picture_along(std::span<const std::size_t> places, const Whitted& tracer,
                                     const accel::PrimaryRays& rays, const accel::HitBuffer& hits,
                                     const PictureWatch& watch) {
  const auto at_once = static_cast<std::size_t>(tracer.batch());
  const auto samples = static_cast<std::size_t>(rays.samples());
  std::vector<glm::dvec3> sums(places.size() / samples, glm::dvec3(0.0));
  Whitted::Progress progress = tracer.begin();
  for (std::size_t first = 0; first < places.size(); first += at_once) {
    if (watch) watch(static_cast<double>(first) / static_cast<double>(places.size()));
    const auto some = places.subspan(first, std::min(at_once, places.size() - first));
    Batch batch;
    batch.reserve(some.size());
    for (const std::size_t place : some) batch.add(rays::ray_at(rays, place), place, hits);
    batch.shade(tracer, rays, progress);
    for (std::size_t i = 0; i < some.size(); ++i) sums[some[i] / samples] += batch.colors[i];
  }
  WhittedPicture picture{Image(rays.width(), rays.height()), progress.census};
  const double share = 1.0 / rays.samples();
  std::ranges::transform(sums, picture.image.pixels().begin(),
                         [share](const glm::dvec3& sum) { return glm::vec3(share * sum); });
  return picture;
}

RayCensus draw_in_order(const Whitted& tracer, const accel::PrimaryRays& rays,
                        const accel::HitBuffer& hits, Image& image) {
  RayCensus census;
  const Parts parts(rays, tracer);
  for (const PixelRange& part : parts.ranges()) {
    census += draw(parts, part, tracer, rays, hits, image);
  }
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
  const auto beams = accel::inspector_of(structure).beams(rays);
  if (!beams) {
    throw InputError(
        "only beam tracers have an order of beams: use --accel beam, with parameters if you like, "
        "or --order scan");
  }
  std::vector<std::size_t> places;
  for (const accel::BeamOutline& beam : *beams) {
    places.insert(places.end(), beam.samples.begin(), beam.samples.end());
  }
  std::vector<bool> seen(rays.count(), false);
  for (const std::size_t place : places) seen[place] = true;
  for (std::size_t place = 0; place < rays.count(); ++place) {
    if (!seen[place]) places.push_back(place);
  }
  return places;
}

}  // namespace beambench::render

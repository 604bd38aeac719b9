#include "harness/render/whitted_picture.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <numeric>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include "accel/beam/beam_tracer.hpp"
#include "harness/base/messages.hpp"
#include "harness/rays/trace_input.hpp"
#include "scenes/core/error.hpp"

namespace beambench::render {
namespace {

/// Samples that are shaded at once, about.
constexpr std::size_t kSamples = 8192;

/// Pixels that are shaded together, in square blocks of `block` pixels a side: of each block one
/// sample of all its pixels after the other.
struct Part {
  int left;
  int top;
  int right;
  int bottom;
  int block;
};

std::vector<Part> parts_of(const accel::PrimaryRays& rays, bool in_rows) {
  constexpr int kBlock = 4;
  const double side = std::sqrt(static_cast<double>(kSamples) / rays.samples());
  const int tile = kBlock * std::max(static_cast<int>(side) / kBlock, 1);
  const int width = in_rows ? rays.width() : tile;
  const int height = in_rows ? 1 : tile;
  std::vector<Part> parts;
  for (int top = 0; top < rays.height(); top += height) {
    for (int left = 0; left < rays.width(); left += width) {
      parts.push_back({left, top, std::min(left + width, rays.width()),
                       std::min(top + height, rays.height()), in_rows ? 1 : kBlock});
    }
  }
  return parts;
}

/// Calls `visit(x, y, sample)` in the order in which a part is shaded.
template <class Visit>
void for_each_sample(const Part& part, int samples, Visit visit) {
  for (int top = part.top; top < part.bottom; top += part.block) {
    for (int left = part.left; left < part.right; left += part.block) {
      for (int sample = 0; sample < samples; ++sample) {
        for (int y = top; y < std::min(top + part.block, part.bottom); ++y) {
          for (int x = left; x < std::min(left + part.block, part.right); ++x) visit(x, y, sample);
        }
      }
    }
  }
}

/// Camera rays, and what they found and receive.
struct Batch {
  std::vector<accel::Ray> rays;
  std::vector<std::optional<accel::Hit>> hits;
  std::vector<glm::dvec3> colors;

  void reserve(std::size_t count) {
    rays.reserve(count);
    hits.reserve(count);
  }
  /// Component by component: a copy would wait until the ray that was just made is in memory.
  void add(const accel::Ray& ray, const std::optional<accel::Hit>& hit) {
    accel::Ray& own = rays.emplace_back();
    own.origin = ray.origin;
    own.direction = ray.direction;
    hits.push_back(hit);
  }
  void shade(const Whitted& tracer, Whitted::Progress& progress) {
    colors.resize(rays.size());
    tracer.trace_light(rays, hits, colors, progress);
  }
};

/// Draws a part with a shadow cache of its own, so that its census is the same however parts are
/// shared among threads.
RayCensus draw(const Part& part, const Whitted& tracer, const accel::PrimaryRays& rays,
               const accel::HitBuffer& hits, Image& image) {
  Batch batch;
  batch.reserve(static_cast<std::size_t>(part.right - part.left) *
                static_cast<std::size_t>(part.bottom - part.top) *
                static_cast<std::size_t>(rays.samples()));
  for_each_sample(part, rays.samples(), [&](int x, int y, int sample) {
    batch.add(rays.ray(x, y, sample), hits.get(hits.index(x, y, sample)));
  });
  Whitted::Progress progress = tracer.begin();
  batch.shade(tracer, progress);
  const auto width = static_cast<std::size_t>(part.right - part.left);
  std::vector<glm::dvec3> sums(width * static_cast<std::size_t>(part.bottom - part.top),
                               glm::dvec3(0.0));
  auto color = batch.colors.begin();
  for_each_sample(part, rays.samples(), [&](int x, int y, int) {
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

WhittedPicture whitted_picture(const Whitted& tracer, const accel::PrimaryRays& rays,
                               const accel::HitBuffer& hits, const PictureWatch& watch,
                               int threads) {
  std::optional<tbb::global_control> limit;
  if (threads > 0) {
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
  WhittedPicture picture{Image(rays.width(), rays.height()), {}};
  const std::vector<Part> parts = parts_of(rays, tracer.remembers_shadows());
  std::vector<RayCensus> counts(parts.size());
  std::atomic<std::size_t> done = 0;
  const auto draw_all = [&] {
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) {
      counts[i] = draw(parts[i], tracer, rays, hits, picture.image);
      ++done;
    });
  };
  if (watch) {
    auto all = std::async(std::launch::async, draw_all);
    while (all.wait_for(std::chrono::milliseconds(100)) == std::future_status::timeout) {
      watch(static_cast<double>(done.load()) / static_cast<double>(parts.size()));
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
  const auto samples = static_cast<std::size_t>(rays.samples());
  std::vector<glm::dvec3> sums(places.size() / samples, glm::dvec3(0.0));
  Whitted::Progress progress = tracer.begin();
  for (std::size_t first = 0; first < places.size(); first += kSamples) {
    if (watch) watch(static_cast<double>(first) / static_cast<double>(places.size()));
    const auto some = places.subspan(first, std::min(kSamples, places.size() - first));
    Batch batch;
    batch.reserve(some.size());
    for (const std::size_t place : some) batch.add(rays::ray_at(rays, place), hits.get(place));
    batch.shade(tracer, progress);
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
  for (const Part& part : parts_of(rays, tracer.remembers_shadows())) {
    census += draw(part, tracer, rays, hits, image);
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

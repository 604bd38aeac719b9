#include "harness/thesis/sampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "harness/base/stopwatch.hpp"
#include "harness/measure/record/robust_statistics.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/render/picture/color.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/shading.hpp"

namespace beambench::thesis {
namespace {

/// Returns display values of an image's pixels.
render::Image displayed(render::Image image) {
  for (glm::vec3& pixel : image.pixels()) pixel = render::srgb_from_linear(pixel);
  return image;
}

double contrast(const glm::vec3& a, const glm::vec3& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

/// Returns the largest contrast of a pixel to its neighbors above, below, left and right.
double contrast_at(const render::Image& image, int x, int y) {
  double largest = 0.0;
  const auto look = [&](int other_x, int other_y) {
    if (other_x < 0 || other_y < 0 || other_x >= image.width() || other_y >= image.height()) return;
    largest = std::max(largest, contrast(image.at(x, y), image.at(other_x, other_y)));
  };
  look(x - 1, y);
  look(x + 1, y);
  look(x, y - 1);
  look(x, y + 1);
  return largest;
}

/// Marks the samples chosen for each pixel, and lists the chosen samples except the first of each
/// pixel.
std::vector<std::size_t> choose(const render::Image& image, const SamplingContrast& contrast,
                                accel::beam::SparseSamples& samples) {
  std::vector<std::size_t> more;
  const int middle = accel::beam::chosen_samples(1).front();
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      const double found = contrast_at(image, x, y);
      const int number = accel::beam::kSampleNumbers[accel::beam::sample_choice(found, contrast.few,
                                                                                contrast.many)];
      for (const int sample : accel::beam::chosen_samples(number)) {
        const std::size_t index = samples.hits.index(x, y, sample);
        samples.number[index] = static_cast<std::uint8_t>(number);
        if (sample != middle) more.push_back(index);
      }
    }
  }
  return more;
}

constexpr int kReferenceSamples = 64;
constexpr std::array<int, 4> kUniform{1, 5, 9, 25};
constexpr std::array<accel::beam::SamplingDensity, 3> kDensities{
    {{0.30, 1.20}, {0.15, 0.60}, {0.05, 0.20}}};
constexpr std::array<SamplingContrast, 3> kContrasts{{{0.10, 0.50}, {0.05, 0.30}, {0.02, 0.10}}};

/// One run of a sampling method.
struct Attempt {
  double ms;
  double rays;  ///< in total
  render::Image image;
};

class Sampler {
 public:
  Sampler(const accel::beam::BeamTracer& tracer, const scenes::Scene& scene,
          const rays::ImageOfRays& image)
      : tracer_(&tracer), scene_(&scene), image_(&image) {}

  Attempt uniform(int samples) const {
    const accel::PrimaryRays rays = primary(samples);
    accel::HitBuffer hits(rays.width(), rays.height(), samples);
    const double ms = timed([&] { tracer_->closest_hits(rays, hits, {}); });
    rays::HitCheck(*scene_, "structure 'beam'").require(hits, rays);
    const double traced = static_cast<double>(rays.count()) - leaving(rays);
    return {ms, traced, render::shade(*scene_, rays, hits, render::Shading::kPreview)};
  }

  Attempt object_space(const accel::beam::SamplingDensity& density) const {
    return sparse(
        [&](const accel::PrimaryRays& rays) {
          return accel::beam::trace_object_space(*tracer_, rays, density);
        },
        0.0);
  }

  Attempt image_space(const SamplingContrast& contrast) const {
    return sparse(
        [&](const accel::PrimaryRays& rays) {
          return trace_image_space(*tracer_, *scene_, image_->camera, rays, contrast);
        },
        leaving(primary(1)));
  }

 private:
  accel::PrimaryRays primary(int samples) const {
    return {image_->camera, image_->resolution.width, image_->resolution.height, samples};
  }

  template <class Trace>
  Attempt sparse(Trace trace, double without_ray) const {
    const accel::PrimaryRays rays = primary(accel::beam::kSampleNumbers.back());
    std::optional<accel::beam::SparseSamples> samples;
    const double ms = timed([&] { samples = trace(rays); });
    return {ms, static_cast<double>(samples->taken()) - without_ray,
            sparse_image(*scene_, rays, *samples)};
  }

  /// Returns the number of samples whose beam leaves the scene.
  double leaving(const accel::PrimaryRays& rays) const {
    accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
    accel::WorkCounters counters;
    tracer_->closest_hits(rays, hits, {&counters});
    return static_cast<double>(counters.by_name().at("samples_leaving"));
  }

  template <class Work>
  static double timed(Work work) {
    const base::Stopwatch stopwatch;
    work();
    return stopwatch.milliseconds();
  }

  const accel::beam::BeamTracer* tracer_;
  const scenes::Scene* scene_;
  const rays::ImageOfRays* image_;
};

struct Method {
  std::string name;
  std::string setting;
  std::function<Attempt(const Sampler&)> attempt;
};

std::vector<Method> methods() {
  std::vector<Method> all;
  all.reserve(std::size(kUniform) + std::size(kDensities) + std::size(kContrasts));
  for (const int samples : kUniform) {
    all.push_back({"uniform", fmt::format("{}", samples),
                   [samples](const Sampler& sampler) { return sampler.uniform(samples); }});
  }
  for (const accel::beam::SamplingDensity& density : kDensities) {
    all.push_back({"object-space", fmt::format("{} {}", density.few, density.many),
                   [density](const Sampler& sampler) { return sampler.object_space(density); }});
  }
  for (const SamplingContrast& contrast : kContrasts) {
    all.push_back({"image-space", fmt::format("{} {}", contrast.few, contrast.many),
                   [contrast](const Sampler& sampler) { return sampler.image_space(contrast); }});
  }
  return all;
}

SamplingResult measure(const Method& method, const Sampler& sampler, const render::Image& reference,
                       int repetitions) {
  const Attempt first = method.attempt(sampler);
  std::vector<double> ms{first.ms};
  while (static_cast<int>(ms.size()) < repetitions) ms.push_back(method.attempt(sampler).ms);
  const double pixels = static_cast<double>(reference.width()) * reference.height();
  return {method.name, method.setting, first.rays / pixels, measure::median(ms),
          render::root_mean_square_error(first.image, reference)};
}

}  // namespace

accel::beam::SparseSamples trace_image_space(const accel::beam::BeamTracer& tracer,
                                             const scenes::Scene& scene,
                                             const scenes::Camera& camera,
                                             const accel::PrimaryRays& rays,
                                             const SamplingContrast& contrast) {
  if (rays.samples() != accel::beam::kSampleNumbers.back()) {
    throw std::invalid_argument("image-space sampling chooses among 25 samples per pixel");
  }
  const accel::PrimaryRays first(camera, rays.width(), rays.height(), 1);
  accel::HitBuffer hits(rays.width(), rays.height(), 1);
  tracer.closest_hits(first, hits, {});
  rays::HitCheck(scene, "structure 'beam'").require(hits, first);

  accel::beam::SparseSamples samples{accel::HitBuffer(rays.width(), rays.height(), rays.samples()),
                                     {}};
  samples.number.resize(samples.hits.size(), 0);
  const auto middle = static_cast<std::size_t>(accel::beam::chosen_samples(1).front());
  const auto per_pixel = static_cast<std::size_t>(rays.samples());
  for (std::size_t pixel = 0; pixel < hits.size(); ++pixel) {
    samples.hits.set(pixel * per_pixel + middle, hits.get(pixel));
  }
  const auto more = choose(displayed(render::shade(scene, first, hits, render::Shading::kPreview)),
                           contrast, samples);
  for (const std::size_t index : more) {
    samples.hits.set(index, tracer.closest_hit(rays::ray_at(rays, index), nullptr));
  }
  return samples;
}

render::Image sparse_image(const scenes::Scene& scene, const accel::PrimaryRays& rays,
                           const accel::beam::SparseSamples& samples) {
  rays::HitCheck(scene, "structure 'beam'").require(samples.hits, rays);
  const glm::vec3 miss = render::background_color(scene);
  render::Image image(rays.width(), rays.height());
  for (int y = 0; y < rays.height(); ++y) {
    for (int x = 0; x < rays.width(); ++x) {
      glm::vec3 color(0.0F);
      float covered = 0.0F;
      for (int sample = 0; sample < rays.samples(); ++sample) {
        const std::size_t index = samples.hits.index(x, y, sample);
        if (samples.number[index] == 0) continue;
        const float part = 1.0F / static_cast<float>(samples.number[index]);
        const auto hit = samples.hits.get(index);
        color += part * (hit ? render::preview_color(scene, rays.ray(x, y, sample), *hit) : miss);
        covered += part;
      }
      image.at(x, y) = covered > 1.0F ? color / covered : color + (1.0F - covered) * miss;
    }
  }
  return image;
}

std::size_t sampling_steps() { return 1 + methods().size(); }

std::vector<SamplingResult> compare_sampling(const accel::beam::BeamTracer& tracer,
                                             const scenes::Scene& scene,
                                             const rays::ImageOfRays& image, int repetitions,
                                             base::Progress& progress) {
  rays::require_ray_count(image.resolution, kReferenceSamples);
  const Sampler sampler(tracer, scene, image);
  progress.start("64 samples per pixel, the reference");
  const render::Image reference = sampler.uniform(kReferenceSamples).image;
  progress.finish("done");
  std::vector<SamplingResult> results;
  for (const Method& method : methods()) {
    progress.start(method.name + ' ' + method.setting);
    results.push_back(measure(method, sampler, reference, repetitions));
    progress.finish(
        fmt::format("error {:.3g}, {:.4g} ms", results.back().error, results.back().trace_ms));
  }
  return results;
}

std::vector<float> samples_by_pixel(const accel::beam::SparseSamples& samples) {
  const auto per_pixel = static_cast<std::size_t>(samples.hits.samples());
  std::vector<float> counts(samples.hits.size() / per_pixel, 0.0F);
  for (std::size_t i = 0; i < samples.number.size(); ++i) {
    if (samples.number[i] != 0) counts[i / per_pixel] += 1.0F;
  }
  return counts;
}

}  // namespace beambench::thesis

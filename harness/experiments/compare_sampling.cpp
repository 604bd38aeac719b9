#include "harness/experiments/compare_sampling.hpp"

#include <array>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "harness/base/stopwatch.hpp"
#include "harness/bench/record/robust_statistics.hpp"
#include "harness/experiments/image_space_sampling.hpp"
#include "harness/experiments/sparse_image.hpp"
#include "harness/rays/hit_check.hpp"
#include "harness/render/picture/image.hpp"
#include "harness/render/shading.hpp"

namespace beambench::experiments {
namespace {

constexpr int kReferenceSamples = 64;
constexpr std::array<int, 4> kUniform{1, 5, 9, 25};
constexpr std::array<accel::beam::SamplingDensity, 3> kDensities{
    {{0.30, 1.20}, {0.15, 0.60}, {0.05, 0.20}}};
constexpr std::array<SamplingContrast, 3> kContrasts{{{0.10, 0.50}, {0.05, 0.30}, {0.02, 0.10}}};

/// One way of sampling, done once.
struct Attempt {
  double ms;
  double rays;  ///< in all
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
    const double ms = timed([&] { tracer_->trace(rays, hits, nullptr); });
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

  /// Samples that leave the scene with their beam.
  double leaving(const accel::PrimaryRays& rays) const {
    accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
    accel::WorkCounters counters;
    tracer_->trace(rays, hits, &counters);
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

struct Way {
  std::string method;
  std::string setting;
  std::function<Attempt(const Sampler&)> attempt;
};

std::vector<Way> ways() {
  std::vector<Way> all;
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

SamplingResult measure(const Way& way, const Sampler& sampler, const render::Image& reference,
                       int repetitions) {
  const Attempt first = way.attempt(sampler);
  std::vector<double> ms{first.ms};
  while (static_cast<int>(ms.size()) < repetitions) ms.push_back(way.attempt(sampler).ms);
  const double pixels = static_cast<double>(reference.width()) * reference.height();
  return {way.method, way.setting, first.rays / pixels, bench::median(ms),
          render::root_mean_square_error(first.image, reference)};
}

}  // namespace

std::size_t sampling_steps() { return 1 + ways().size(); }

std::vector<SamplingResult> compare_sampling(const accel::beam::BeamTracer& tracer,
                                             const scenes::Scene& scene,
                                             const rays::ImageOfRays& image, int repetitions,
                                             base::Progress& progress) {
  rays::require_ray_count(image.resolution, kReferenceSamples);
  const Sampler sampler(tracer, scene, image);
  progress.start("64 samples a pixel, the reference");
  const render::Image reference = sampler.uniform(kReferenceSamples).image;
  progress.finish("done");
  std::vector<SamplingResult> results;
  for (const Way& way : ways()) {
    progress.start(way.method + ' ' + way.setting);
    results.push_back(measure(way, sampler, reference, repetitions));
    progress.finish(
        fmt::format("error {:.3g}, {:.4g} ms", results.back().error, results.back().trace_ms));
  }
  return results;
}

std::vector<float> samples_by_pixel(const accel::beam::SparseSamples& samples) {
  const auto a_pixel = static_cast<std::size_t>(samples.hits.samples());
  std::vector<float> counts(samples.hits.size() / a_pixel, 0.0F);
  for (std::size_t i = 0; i < samples.number.size(); ++i) {
    if (samples.number[i] != 0) counts[i / a_pixel] += 1.0F;
  }
  return counts;
}

}  // namespace beambench::experiments

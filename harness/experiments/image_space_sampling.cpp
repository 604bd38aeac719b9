#include "harness/experiments/image_space_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "harness/rays/hit_check.hpp"
#include "harness/render/picture/color.hpp"
#include "harness/render/shading.hpp"

namespace beambench::experiments {
namespace {

/// Display values of an image's pixels.
render::Image displayed(render::Image image) {
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x)
      image.at(x, y) = render::srgb_from_linear(image.at(x, y));
  }
  return image;
}

double contrast(const glm::vec3& a, const glm::vec3& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

/// The largest contrast of a pixel to its neighbors above, below, left and right.
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

/// Marks the samples that pixels get, and lists those beyond the first.
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

}  // namespace

accel::beam::SparseSamples trace_image_space(const accel::beam::BeamTracer& tracer,
                                             const scenes::Scene& scene,
                                             const scenes::Camera& camera,
                                             const accel::PrimaryRays& rays,
                                             const SamplingContrast& contrast) {
  if (rays.samples() != accel::beam::kSampleNumbers.back()) {
    throw std::invalid_argument("image-space sampling chooses among 25 samples a pixel");
  }
  const accel::PrimaryRays first(camera, rays.width(), rays.height(), 1);
  accel::HitBuffer hits(rays.width(), rays.height(), 1);
  tracer.trace(first, hits, nullptr);
  rays::HitCheck(scene, "structure 'beam'").require(hits, first);

  accel::beam::SparseSamples samples{accel::HitBuffer(rays.width(), rays.height(), rays.samples()),
                                     {}};
  samples.number.resize(samples.hits.size(), 0);
  const auto middle = static_cast<std::size_t>(accel::beam::chosen_samples(1).front());
  const auto a_pixel = static_cast<std::size_t>(rays.samples());
  for (std::size_t pixel = 0; pixel < hits.size(); ++pixel) {
    samples.hits.set(pixel * a_pixel + middle, hits.get(pixel));
  }
  const auto more = choose(displayed(render::shade(scene, first, hits, render::Shading::kPreview)),
                           contrast, samples);
  const auto width = static_cast<std::size_t>(rays.width());
  for (const std::size_t index : more) {
    const std::size_t pixel = index / a_pixel;
    samples.hits.set(index, tracer.closest_hit(rays.ray(static_cast<int>(pixel % width),
                                                        static_cast<int>(pixel / width),
                                                        static_cast<int>(index % a_pixel)),
                                               nullptr));
  }
  return samples;
}

}  // namespace beambench::experiments

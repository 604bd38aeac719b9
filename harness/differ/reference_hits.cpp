#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

#include "harness/differ/differ.hpp"

namespace beambench {

ReferenceHits::ReferenceHits(const Scene& scene, const PrimaryRays& rays)
    : scene_(&scene), rays_(&rays), hits_(rays.count()) {
  const EmbreeOracle oracle(scene, glm::length(glm::dvec3(rays.eye())));
  const auto samples = static_cast<std::size_t>(rays.samples());
  const std::size_t row_length = static_cast<std::size_t>(rays.width()) * samples;
  tbb::parallel_for(0, rays.height(), [&](int y) {
    std::size_t index = static_cast<std::size_t>(y) * row_length;
    for (int x = 0; x < rays.width(); ++x) {
      for (int sample = 0; sample < rays.samples(); ++sample) {
        hits_[index++] = oracle.closest_hit(rays.ray(x, y, sample));
      }
    }
  });
}

ReferenceHits::ReferenceHits(const Scene& scene, const PrimaryRays& rays,
                             std::vector<std::optional<ExactHit>> hits)
    : scene_(&scene), rays_(&rays), hits_(std::move(hits)) {
  if (hits_.size() != rays.count()) {
    throw std::logic_error(
        fmt::format("{} reference hits are given for {} rays", hits_.size(), rays.count()));
  }
}

}  // namespace beambench

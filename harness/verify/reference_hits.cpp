#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "harness/verify/differ.hpp"

namespace beambench::verify {

ReferenceHits::ReferenceHits(const scenes::Scene& scene, rays::Question question)
    : scene_(&scene), question_(std::move(question)), hits_(question_.size()) {
  const accel::embree::EmbreeOracle oracle(scene, question_.reach());
  tbb::parallel_for(tbb::blocked_range(std::size_t{0}, hits_.size(), 1024),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        hits_[i] = oracle.closest_hit(question_.ray(i));
                      }
                    });
}

ReferenceHits::ReferenceHits(const scenes::Scene& scene, rays::Question question,
                             std::vector<std::optional<accel::embree::ExactHit>> hits)
    : scene_(&scene), question_(std::move(question)), hits_(std::move(hits)) {
  if (hits_.size() != question_.size()) {
    throw std::logic_error(
        fmt::format("{} reference hits are given for {} rays", hits_.size(), question_.size()));
  }
}

std::uint64_t ReferenceHits::hit_count() const {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(hits_, [](const auto& hit) { return hit.has_value(); }));
}

}  // namespace beambench::verify

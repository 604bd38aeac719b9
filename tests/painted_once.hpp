#pragma once
// Checks images traced by beams, sample by sample: each sample belongs to one beam, however beams
// are divided.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "accel/beam/beam_watch.hpp"
#include "accel/core/accelerator.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "scenes/base/random.hpp"
#include "scenes/scene.hpp"
#include "tests/random_view.hpp"

namespace beambench::tests {

/// Counts how often each place of the hit buffer was painted, and how samples ended.
class PaintWatch : public accel::beam::NoBeamWatch {
 public:
  static constexpr bool kPaintsLeaving = true;

  explicit PaintWatch(std::size_t places) : painted_(places, 0) {}
  void painted(std::size_t index) { ++painted_[index]; }
  void handed_over(accel::beam::RayReason reason) { ++reasons_[static_cast<std::size_t>(reason)]; }

  std::uint8_t times(std::size_t index) const { return painted_[index]; }
  std::uint64_t rays_by(accel::beam::RayReason reason) const {
    return reasons_[static_cast<std::size_t>(reason)];
  }

 private:
  std::vector<std::uint8_t> painted_;
  std::array<std::uint64_t, 3> reasons_{};
};

/// Traces an image. Each sample whose ray `meets` the structure must be painted once, and all other
/// samples never. No sample may become a ray because of crowding. The hits of all samples, or of
/// every `stride`-th sample, must equal those of `exhaustive`. Returns how samples ended.
template <class Tracer, class Meets>
PaintWatch expect_painted_once(const scenes::Scene& scene, const Tracer& tracer, const Meets& meets,
                               const accel::PrimaryRays& rays, std::size_t stride = 1) {
  const accel::exhaustive::Exhaustive exhaustive(scene);
  accel::HitBuffer buffer(rays.width(), rays.height(), rays.samples());
  PaintWatch watch(buffer.size());
  tracer.trace_watched(rays, buffer, watch);
  std::size_t wrong_paint = 0;
  std::size_t wrong_hits = 0;
  std::string first;
  for (int y = 0; y < rays.height(); ++y) {
    for (int x = 0; x < rays.width(); ++x) {
      for (int sample = 0; sample < rays.samples(); ++sample) {
        const std::size_t index = buffer.index(x, y, sample);
        const accel::Ray ray = rays.ray(x, y, sample);
        const int expected = meets(ray) ? 1 : 0;
        const bool paint_is_wrong = watch.times(index) != expected;
        const bool hit_is_wrong =
            index % stride == 0 && buffer.get(index) != exhaustive.closest_hit(ray, nullptr);
        if (paint_is_wrong) ++wrong_paint;
        if (hit_is_wrong) ++wrong_hits;
        if ((paint_is_wrong || hit_is_wrong) && first.empty()) {
          first = fmt::format("first at ({}, {}) sample {}, painted {} times, expected {}", x, y,
                              sample, watch.times(index), expected);
        }
      }
    }
  }
  EXPECT_EQ(wrong_paint, 0U) << first;
  EXPECT_EQ(wrong_hits, 0U) << first;
  EXPECT_EQ(watch.rays_by(accel::beam::RayReason::kCrowded), 0U);
  return watch;
}

/// Returns a random view, narrow or wide.
inline scenes::Camera random_camera(const scenes::Scene& scene, Random& random) {
  scenes::Camera camera = random_view(scene, random);
  const glm::vec3 view = camera.at - camera.from;
  camera.up = {0.0F, 1.0F, 0.0F};
  if (std::abs(view.x) + std::abs(view.z) < 1e-3F * std::abs(view.y)) {
    camera.up = {0.0F, 0.0F, 1.0F};
  }
  camera.angle = std::array{5.0F, 45.0F, 90.0F, 170.0F}[random.below(4)];
  camera.aspect = std::array{1.0F, 1.6F, 0.4F}[random.below(3)];
  return camera;
}

}  // namespace beambench::tests

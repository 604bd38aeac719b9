#pragma once
// Samples tested together against the references of a leaf.

#include <bit>
#include <span>
#include <vector>

#include "accel/beam/primitive_image.hpp"
#include "accel/beam/sample_lattice.hpp"
#include "accel/core/intersect.hpp"

namespace beambench::accel::beam {

/// The ray of a sample, whose point at t has the view depth start + speed * t.
struct SampleRay {
  Ray ray;
  float start;
  float speed;
};

/// Up to `SampleBatch::kCapacity` samples with their rays and their hits so far.
class LeafBatch {
 public:
  struct Sample {
    Sample(const SampleLattice& in, int at_x, int at_y, const SampleRay& through)
        : lattice(&in),
          x(at_x),
          y(at_y),
          ray(through.ray),
          closest(through.ray),
          start(through.start),
          speed(through.speed) {}

    const SampleLattice* lattice;
    int x;
    int y;
    Ray ray;
    ClosestHit closest;
    float start;
    float speed;
  };

  LeafBatch() { samples_.reserve(SampleBatch::kCapacity); }

  bool full() const { return samples_.size() == SampleBatch::kCapacity; }
  std::span<Sample> samples() { return samples_; }

  /// Adds a sample. The batch must not be full.
  Sample& add(const SampleLattice& lattice, int x, int y, const SampleRay& ray) {
    return samples_.emplace_back(lattice, x, y, ray);
  }
  void clear() { samples_.clear(); }

  /// Tests all samples against the references by the canonical test, one sample after another, as
  /// structures that trace single rays do.
  template <class Counting>
  void test(const scenes::Scene& scene, std::span<const scenes::PrimitiveId> references,
            Counting& counting) {
    for (Sample& sample : samples_) {
      for (const scenes::PrimitiveId id : references) test(scene, id, sample, counting);
    }
  }

  /// Tests all samples against the references: by the primitives' images first, which only reject,
  /// then by the canonical test.
  template <class Counting>
  void test(const scenes::Scene& scene, std::span<const scenes::PrimitiveId> references,
            PrimitiveImages& images, Counting& counting) {
    find_places();
    for (const scenes::PrimitiveId id : references) {
      for (SampleMask left = images.may_hit(id, places_); left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        if (test(scene, id, samples_[i], counting)) places_.inverse_t[i] = limit(samples_[i]);
      }
    }
  }

 private:
  /// Runs the canonical test. Returns whether it found a hit.
  template <class Counting>
  static bool test(const scenes::Scene& scene, scenes::PrimitiveId id, Sample& sample,
                   Counting& counting) {
    counting.add_tests(scene.primitives[id].kind);
    const float t = sample.closest.test(scene, id);
    counting.tested(id, t);
    return is_hit(t);
  }

  /// Sets the places and limits of all samples, for tests by images.
  void find_places() {
    places_.size = samples_.size();
    for (std::size_t i = 0; i < places_.size; ++i) {
      const Sample& sample = samples_[i];
      places_.x[i] = static_cast<float>(sample.x + sample.lattice->offset.x);
      places_.y[i] = static_cast<float>(sample.y + sample.lattice->offset.y);
      places_.inverse_t[i] = limit(sample);
    }
  }

  /// Returns a bound on 1 / view depth that a hit must exceed to be nearer than the closest so far.
  static float limit(const Sample& sample) {
    constexpr float kLess = 1.0F - 0x1p-20F;
    return kLess / (sample.start + sample.speed * sample.closest.ray.t_max);
  }

  std::vector<Sample> samples_;
  SampleBatch places_;
};

}  // namespace beambench::accel::beam

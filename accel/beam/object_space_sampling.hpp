#pragma once
// Chooses the number of samples of a pixel where its beam ends, from the objects and the size of
// the leaf.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "accel/beam/beam_tracer.hpp"

namespace beambench::accel::beam {

/// The rule by which the leaf at which a beam ends determines the number of samples. The thesis
/// proposes this; its own beams (section 5.3.2) take no samples in pixels of leaving beams and the
/// same number in all others. A leaf with `n` references that is `w` pixels wide (depending on its
/// depth and distance) shows an estimated n edges of length w in w x w pixels: n / w edges per
/// pixel. From the thresholds `few` and `many` on, the leaf's pixels get more samples.
struct SamplingDensity {
  double few = 0.15;   ///< threshold in edges per pixel for 5 samples instead of 1
  double many = 0.60;  ///< threshold in edges per pixel for 25 samples
};

/// An image whose pixels have 1, 5 or 25 samples of the same regular grid of 5 x 5.
struct SparseSamples {
  /// 25 samples per pixel; those that were not taken are misses.
  HitBuffer hits;
  /// For each place in `hits`: 0 if no sample was taken; otherwise the number of samples per pixel,
  /// 1, 5 or 25, of the leaf that took it. A sample represents 1/number of its pixel; the rest of
  /// the pixel is background.
  std::vector<std::uint8_t> number;

  /// Returns the number of samples taken, without those of leaving beams.
  std::size_t taken() const;
};

/// The numbers of samples that leaves choose from, in increasing order.
inline constexpr std::array<int, 3> kSampleNumbers{1, 5, 25};

/// Returns the index of the number of samples for a value: 0 below `few`, 1 from `few` on, 2 from
/// `many` on.
constexpr std::size_t sample_choice(double value, double few, double many) {
  return value >= many ? 2 : value >= few ? 1 : 0;
}

/// Returns the samples of a pixel with `number` samples, as places in the grid of 5 x 5 (row by
/// row): all of them, one in each row and column, or the middle one.
std::span<const int> chosen_samples(int number);

/// Traces an image by beams; each leaf chooses the number of its samples. `rays` must have 25
/// samples per pixel (std::invalid_argument).
SparseSamples trace_object_space(const BeamTracer& tracer, const PrimaryRays& rays,
                                 const SamplingDensity& density);

}  // namespace beambench::accel::beam

#include "accel/beam/object_space_sampling.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include <glm/geometric.hpp>

namespace beambench::accel::beam {
namespace {

constexpr std::array<int, 1> kOne{12};
/// Five samples, no two in one row or column, so that an edge along a row or column meets five
/// different positions, not three.
constexpr std::array<int, 5> kFive{1, 9, 12, 15, 23};
constexpr std::array<int, 25> kAll = [] {
  std::array<int, 25> all{};
  std::iota(all.begin(), all.end(), 0);
  return all;
}();

/// Chooses the lattices of each beam's samples by the leaf where the beam ends.
class ChoosingWatch : public NoBeamWatch {
 public:
  ChoosingWatch(const BeamTracer& tracer, const PrimaryRays& rays, const SamplingDensity& density,
                std::vector<std::uint8_t>& number)
      : octree_(&tracer.octree()),
        rays_(&rays),
        density_(density),
        pixel_(glm::length(rays.across()) / rays.width()),
        number_(&number) {
    const std::vector<SampleLattice> all = sample_lattices(rays, false);
    for (std::size_t i = 0; i < kSampleNumbers.size(); ++i) {
      for (const int sample : chosen_samples(kSampleNumbers[i])) {
        lattices_[i].push_back(all[static_cast<std::size_t>(sample)]);
      }
    }
  }

  void met(BeamKind kind, const Beam& beam) {
    const double edges = kind == BeamKind::kOccupied ? edges_a_pixel(beam) : density_.many;
    choice_ = sample_choice(edges, density_.few, density_.many);
  }
  std::span<const SampleLattice> chosen(std::span<const SampleLattice>) const {
    return lattices_[choice_];
  }
  void painted(std::size_t index) {
    (*number_)[index] = static_cast<std::uint8_t>(kSampleNumbers[choice_]);
  }

 private:
  double edges_a_pixel(const Beam& beam) const {
    const CellGrid& grid = octree_->grid();
    const Box cell = grid.box(beam.corner, beam.size);
    const glm::dvec3 middle = 0.5 * (cell.lower + cell.upper);
    const double depth = glm::dot(middle - glm::dvec3(rays_->eye()), rays_->forward());
    const double size = cell.upper.x - cell.lower.x;
    const double pixels = size / (pixel_ * std::max(depth, 0.5 * size));
    return octree_->nodes()[beam.node].count / pixels;
  }

  const octree::Octree* octree_;
  const PrimaryRays* rays_;
  SamplingDensity density_;
  double pixel_;  ///< a pixel's width at distance 1
  std::vector<std::uint8_t>* number_;
  std::array<std::vector<SampleLattice>, kSampleNumbers.size()> lattices_;
  std::size_t choice_ = 0;
};

}  // namespace

std::span<const int> chosen_samples(int number) {
  if (number == 1) return kOne;
  if (number == 5) return kFive;
  return kAll;
}

std::size_t SparseSamples::taken() const {
  return number.size() - static_cast<std::size_t>(std::ranges::count(number, 0));
}

SparseSamples trace_object_space(const BeamTracer& tracer, const PrimaryRays& rays,
                                 const SamplingDensity& density) {
  if (rays.samples() != kSampleNumbers.back()) {
    throw std::invalid_argument("object-space sampling chooses among 25 samples per pixel");
  }
  SparseSamples samples{HitBuffer(rays.width(), rays.height(), rays.samples()), {}};
  samples.number.resize(samples.hits.size(), 0);
  ChoosingWatch watch(tracer, rays, density, samples.number);
  tracer.trace_watched(rays, samples.hits, watch);
  return samples;
}

}  // namespace beambench::accel::beam

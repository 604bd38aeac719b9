#pragma once
// The rays traced by beams: a whole image, or the rays that a plane reflects or refracts.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "accel/beam/beam_options.hpp"
#include "accel/beam/beam_paths.hpp"
#include "accel/beam/beam_samples.hpp"
#include "accel/beam/crossing.hpp"
#include "accel/beam/drifting_view.hpp"
#include "accel/beam/leaf_batch.hpp"
#include "accel/core/ray.hpp"

namespace beambench::accel::beam {

/// The policy of an image: all samples, with rays from the eye.
struct WholeImage {
  /// Whether samples of leaving beams must be recorded as finished.
  static constexpr bool kRecordsLeaving = false;

  static EyeView view(const CellGrid& grid, const PrimaryRays& rays) { return {grid, rays}; }
  static ImagePolygon part(const EyeView& view) { return view.screen(); }
  static std::vector<SampleLattice> lattices(const PrimaryRays& rays, bool share_corners) {
    return sample_lattices(rays, share_corners);
  }
  /// Returns the number of samples below which a beam becomes individual rays.
  static std::int64_t handover(const BeamRules& rules) { return rules.handover; }
  static const PassedNodes* passed() { return nullptr; }
  /// Returns the samples that need no tracing; empty if all need it.
  static std::vector<std::uint8_t> finished() { return {}; }
  static Ray ray_of(const SampleScan& scan, const SampleLattice& lattice, int x, int y) {
    return scan.ray(lattice, x, y);
  }
  static SampleRay ray(const SampleScan& scan, const SampleLattice& lattice, int x, int y) {
    return {scan.ray(lattice, x, y), 0.0F, 1.0F};
  }
};

/// The policy of rays that begin at a plane that reflects or refracts them, as samples of an image
/// seen from behind it (Heckbert and Hanrahan, "Beam tracing polygonal objects", SIGGRAPH 1984;
/// thesis, section 7.3).
///
/// Beams are divided as seen from one eye, but the rays are those of a list, whose lines pass near
/// the eye (`NearbyRays`). So the parts of a beam overlap accordingly, and each ray determines
/// which part it belongs to. Objects behind the plane of the rays' origins do not divide beams:
/// nodes that hold nothing in front of the plane, such as those that hold only a mirror, are
/// passed.
class BehindPlane : public PassedNodes {
 public:
  static constexpr bool kRecordsLeaving = true;

  /// The minimum number of rays; fewer rays are traced singly. In parts of 64x64 pixels at 640x480,
  /// tracing rays singly takes 0.92 (ajedrez) to 1.5 times as long as in beams for 128 to 255 rays,
  /// and 0.58 to 1.4 times as long for 64 to 127 rays.
  static constexpr std::size_t kFewest = 128;

  /// Takes rays, the samples they came from, and the view of them from an eye that may drift. Rays
  /// that deviate by more than `limit` pixels are left out. All arguments must outlive this object.
  BehindPlane(std::span<const Ray> rays, std::span<const std::uint32_t> samples,
              const DriftingView& view, double limit, const scenes::Scene& scene,
              const octree::Octree& octree);

  /// Returns a buffer for the smallest part of the image that contains all samples.
  HitBuffer buffer() const { return {size_.x, size_.y, view_->samples()}; }
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  /// Returns the place of each ray in the buffer, or kNone if it is left out.
  std::span<const std::uint32_t> places() const { return places_; }
  const PrimaryRays& image() const { return *view_; }

  EyeView view(const CellGrid& grid, const PrimaryRays& rays) const {
    return {grid, rays, nearby_};
  }
  const ImagePolygon& part(const EyeView&) const { return part_; }
  /// Returns the lattices of the samples; each sample has its own ray, even at pixel corners.
  std::vector<SampleLattice> lattices(const PrimaryRays& rays, bool share_corners) const;
  /// Returns 1 for each place of the buffer without a ray.
  std::vector<std::uint8_t> finished() const;
  /// Returns the number of samples below which a beam becomes individual rays; positive even if the
  /// option is 0.
  static std::int64_t handover(const BeamRules& rules);
  /// Returns the ray of a sample; the image's own ray if the list has none for it.
  Ray ray_of(const SampleScan& scan, const SampleLattice& lattice, int x, int y) const {
    const std::uint32_t ray = ray_at_[index_of(x, y, lattice)];
    return ray == kNone ? scan.ray(lattice, x, y) : rays_[ray];
  }
  SampleRay ray(const SampleScan&, const SampleLattice& lattice, int x, int y) const;
  const PassedNodes* passed() const { return this; }
  /// Returns whether all contents of a node are behind the plane of the rays' origins.
  bool has(const octree::OctreeCursor& node) const override;

 private:
  std::size_t index_of(int x, int y, const SampleLattice& lattice) const {
    return index_of(x, y, static_cast<std::size_t>(lattice.places.front().sample));
  }
  /// Returns the index in a buffer of the part, like `HitBuffer::index`.
  std::size_t index_of(int x, int y, std::size_t sample) const {
    const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) +
                              static_cast<std::size_t>(x);
    return pixel * static_cast<std::size_t>(view_->samples()) + sample;
  }
  /// Calls `visit(ray)` for the rays that are not left out.
  template <class Visit>
  void for_each_taken(Visit visit) const {
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      if (places_[i] != kNone) visit(rays_[i]);
    }
  }
  void choose_part();
  void take_rays(const DriftingView& view, double limit);
  void find_plane();
  bool is_behind(scenes::PrimitiveId id) const;

  const scenes::Scene* scene_;
  const octree::Octree* octree_;
  const PrimaryRays* view_;
  std::span<const Ray> rays_;
  std::span<const std::uint32_t> samples_;
  glm::ivec2 corner_{0};  ///< of the part, in pixels
  glm::ivec2 size_{0};
  std::vector<std::uint32_t> places_;
  std::vector<std::uint32_t> ray_at_;  ///< the ray of each place, or kNone
  ImagePolygon part_;
  NearbyRays nearby_{};
  /// All rays lie where dot(normal_, point) > limit_.
  glm::dvec3 normal_{0.0};
  double limit_ = 0.0;
};

}  // namespace beambench::accel::beam

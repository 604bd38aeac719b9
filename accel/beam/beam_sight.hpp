#pragma once
// What beams are traced for: a whole image, or what a mirror shows.

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
#include "accel/beam/leaf_batch.hpp"
#include "accel/core/ray_batch.hpp"

namespace beambench::accel::beam {

/// The policy of an image: all of it, starting at the eye.
struct WholeImage {
  /// Must samples of beams that leave the root be recorded as finished?
  static constexpr bool kRecordsLeaving = false;

  static EyeView view(const CellGrid& grid, const PrimaryRays& rays) { return {grid, rays}; }
  static ImagePolygon part(const EyeView& view) { return view.screen(); }
  static std::vector<SampleLattice> lattices(const PrimaryRays& rays, bool share_corners) {
    return sample_lattices(rays, share_corners);
  }
  /// A beam of fewer samples becomes individual rays.
  static std::int64_t handover(const BeamRules& rules) { return rules.handover; }
  static const PassedNodes* passed() { return nullptr; }
  /// The samples that need no tracing; empty where all need it.
  static std::vector<std::uint8_t> finished() { return {}; }
  static SampleRay ray(const SampleScan& scan, const SampleLattice& lattice, int x, int y) {
    return {scan.ray(lattice, x, y), 0.0F, 1.0F};
  }
};

/// The policy of a mirror: the rays of a pencil, as samples of the image that its virtual eye sees
/// (Heckbert and Hanrahan, "Beam tracing polygonal objects", SIGGRAPH 1984; thesis, section 7.3).
///
/// Beams are divided as seen from the pencil's apex, but what is traced are the pencil's own rays,
/// whose lines pass a little beside it. So beams keep a margin between each other (`NearbyRays`),
/// and the few samples in it are in no beam. What lies behind the plane of the rays' origins does
/// not divide beams: nodes that hold nothing in front of it are passed, those of the mirror among
/// them.
class BehindMirror : public PassedNodes {
 public:
  static constexpr bool kRecordsLeaving = true;

  /// Can a pencil's rays be traced in beams, and are they so many that it pays?
  static bool suits(const RayBatch& batch, const Pencil& pencil);
  /// For a pencil that `suits`. Rays that deviate too far from their samples are left out.
  BehindMirror(const RayBatch& batch, const Pencil& pencil, const scenes::Scene& scene,
               const octree::Octree& octree);

  /// For the hits of the smallest part of the image that has all samples.
  HitBuffer buffer() const { return {size_.x, size_.y, view_->samples()}; }
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  /// For each ray its place in the buffer, or kNone where it is left out.
  std::span<const std::uint32_t> places() const { return places_; }

  EyeView view(const CellGrid& grid, const PrimaryRays& rays) const {
    return {grid, rays, nearby_};
  }
  const ImagePolygon& part(const EyeView&) const { return part_; }
  /// Each sample has a ray of its own, those in the corners of pixels too.
  std::vector<SampleLattice> lattices(const PrimaryRays& rays, bool share_corners) const;
  /// For each place of the buffer 1 if no ray of the pencil has it.
  std::vector<std::uint8_t> finished() const;
  /// Some even where the option is 0.
  static std::int64_t handover(const BeamRules& rules);
  SampleRay ray(const SampleScan&, const SampleLattice& lattice, int x, int y) const;
  const PassedNodes* passed() const { return this; }
  /// Is everything in a node behind the plane of the rays' origins?
  bool has(const octree::OctreeCursor& node) const override;

 private:
  /// A sample's pixel and its number in the pixel.
  struct Place {
    glm::ivec2 pixel;
    std::size_t sample;
  };
  /// How a ray runs, as seen from the apex.
  struct Course {
    double start;   ///< view depth of its origin
    double speed;   ///< view depth per t
    double beside;  ///< how far its line passes beside the apex
    double turned;  ///< how far its direction is from its sample's, at view depth 1
  };

  Place place_of(std::size_t ray) const;
  Course course_of(const Ray& ray, const Place& place) const;
  /// In a buffer of the part, as `HitBuffer::index`.
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
  void take_rays();
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
  std::vector<std::uint32_t> ray_at_;  ///< for each place the ray, or kNone
  ImagePolygon part_;
  NearbyRays nearby_{};
  /// All rays stay where dot(normal_, point) > limit_.
  glm::dvec3 normal_{0.0};
  double limit_ = 0.0;
};

}  // namespace beambench::accel::beam

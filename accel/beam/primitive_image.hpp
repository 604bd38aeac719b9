#pragma once
// The images of primitives, as seen from the eye: conditions that a sample must meet to hit one.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "accel/beam/crossing.hpp"
#include "accel/core/primary_rays.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::beam {

/// The linear function x * px + y * py + constant of a sample's place in pixels, in float.
struct PixelLine {
  float x;
  float y;
  float constant;
};

/// A triangle's edges, nonnegative for samples that may hit it, and 1 / view depth of its plane,
/// which is at least that of any hit. All are widened by the error of float arithmetic and the
/// deviation of rays, so that they reject no hit of the canonical test.
struct TriangleImage {
  std::array<PixelLine, 3> edges;
  PixelLine inverse_t;
};

/// A sphere's outline: xx u^2 + xy u v + yy v^2 + x u + y v + constant, nonnegative for samples
/// that may hit it; (u, v) is a sample's place relative to the center's, in pixels. Widened like a
/// TriangleImage.
struct SphereImage {
  float center_x;
  float center_y;
  float xx;
  float xy;
  float yy;
  float x;
  float y;
  float constant;
};

/// Up to 64 samples of an image.
struct SampleBatch {
  static constexpr std::size_t kCapacity = 64;

  alignas(64) std::array<float, kCapacity> x;  ///< place in pixels
  alignas(64) std::array<float, kCapacity> y;
  /// Slightly less than 1 / view depth of the closest hit; 0 until there is one.
  alignas(64) std::array<float, kCapacity> inverse_t;
  std::size_t size = 0;
};

/// A set of samples: bit i is set if sample i of the batch may hit the primitive no farther away
/// than its closest hit so far.
using SampleMask = std::uint64_t;

/// Returns the mask of all samples of a batch.
inline SampleMask all_samples(const SampleBatch& batch) {
  return batch.size == SampleBatch::kCapacity ? ~SampleMask{0} : (SampleMask{1} << batch.size) - 1;
}

/// Tests many samples against one primitive's image. The tests only reject: samples that pass are
/// confirmed by the canonical test.
struct ProbeKernels {
  /// Returns which samples may hit one of a polygon's triangles.
  SampleMask (*triangles)(std::span<const TriangleImage>, const SampleBatch&);
  SampleMask (*sphere)(const SphereImage&, const SampleBatch&);
  std::int64_t target;  ///< the Highway target for which they are compiled
};

/// Returns the kernels for this machine's best instruction set that Highway supports.
const ProbeKernels& simd_probe_kernels();
/// Returns kernels that test one sample at a time, with the same results.
const ProbeKernels& scalar_probe_kernels();

/// The images of a scene's primitives for one camera and resolution, each made on first use.
class PrimitiveImages {
 public:
  PrimitiveImages(const scenes::Scene& scene, const EyeView& view, const PrimaryRays& rays,
                  const ProbeKernels& kernels);

  SampleMask may_hit(scenes::PrimitiveId id, const SampleBatch& batch);

 private:
  TriangleImage image_of_triangle(const std::array<std::uint32_t, 3>& vertices) const;
  SphereImage image_of_sphere(const scenes::Sphere& sphere) const;

  const scenes::Scene* scene_;
  const ProbeKernels* kernels_;
  glm::dvec3 eye_;
  glm::dvec3 forward_;
  /// direction(px, py) = top_left + right * px + down * py.
  glm::dvec3 top_left_;
  glm::dvec3 right_;
  glm::dvec3 down_;
  glm::dvec2 size_;   ///< of the image, in pixels
  double deviation_;  ///< of a ray's points from its sample's place, as seen from the eye
  /// Returns the place of a primitive's first image in the array of its kind; kNotMade until the
  /// image is made.
  std::uint32_t& place_of(scenes::PrimitiveId id);

  /// The places, in pages of many primitives. A page is empty until one of its primitives is met,
  /// so that the cost of a small part of an image does not depend on the number of primitives.
  std::vector<std::vector<std::uint32_t>> places_;
  std::vector<TriangleImage> triangles_;
  std::vector<SphereImage> spheres_;
};

}  // namespace beambench::accel::beam

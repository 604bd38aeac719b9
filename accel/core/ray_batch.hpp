#pragma once
// A list of rays for one call, and the pencils among them.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/primary_rays.hpp"
#include "accel/core/ray.hpp"

namespace beambench::accel {

/// The rays [first, first + count) of a batch, whose lines pass through one common point, up to the
/// rounding of their numbers. Neighbors in the list are mostly neighbors in the picture.
struct Pencil {
  std::size_t first;
  std::size_t count;
  /// A point light, or the virtual eye of a planar mirror.
  glm::dvec3 apex;
  /// The rays run toward the apex, which is at t = 1, and end there or a little before it, as
  /// shadow rays do: t in [0, t_max]. Otherwise they run away from it, t in [0, infinity], and
  /// begin at some distance from it, as reflected rays begin beside the mirror. A ray may have a
  /// shorter interval, as a shadow ray that goes on behind glass; structures do not hit what lies
  /// beyond it.
  bool toward;
  /// The rays of an image that look from the apex, as far as `RayBatch::samples` says
  /// (`PrimaryRays::mirrored`): the same lines up to rounding, with directions of other lengths and
  /// other origins. Null where there is no such image. Lives as long as the batch.
  const PrimaryRays* view = nullptr;
};

/// Pencils of one light with an extent, such as the samples of an area light: the pencils [first,
/// first + count) of a batch, which follow one another in its list. All are `toward`, their apexes
/// lie close together, and their rays begin at the same origins in the same order, at t = 0, and
/// end at the apex or before it by at most `surface_lift`. So what no ray, or each ray, from an
/// origin to the apexes meets needs to be found only once.
struct PencilBundle {
  std::size_t first;
  std::size_t count;

  friend bool operator==(const PencilBundle&, const PencilBundle&) = default;
};

/// Rays of a batch, [first, first + count), that came from the eye of its image through the same
/// planes, of which at least one refracted them. They have no common point, but neighboring samples
/// have neighboring rays. No ray is also in a pencil.
struct RefractedRays {
  std::size_t first;
  std::size_t count;

  friend bool operator==(const RefractedRays&, const RefractedRays&) = default;
};

/// Further marks of a batch. Like pencils they are hints. Later versions of the interface may add
/// members at the end, so that no structure has to be compiled again for them.
struct BatchMarks {
  std::vector<PencilBundle> bundles;     ///< in the order of `first`; no pencil is in two
  std::vector<RefractedRays> refracted;  ///< in the order of `first`; no ray is in two
};

/// Rays, and the pencils among them: in the order of `first`, and no ray is in two. Pencils are a
/// hint that changes no hit beyond what `Conformance` allows, and the rays are the same bits with
/// and without them: a structure may ignore them.
struct RayBatch {
  std::span<const Ray> rays;
  std::span<const Pencil> pencils{};
  /// The sample of `image` from which each ray came, directly or through other rays, numbered as in
  /// a HitBuffer of the image; empty where rays do not come from an image.
  std::span<const std::uint32_t> samples{};
  const PrimaryRays* image = nullptr;  ///< null where `samples` is empty
  const BatchMarks* marks = nullptr;   ///< null if there are none
};

}  // namespace beambench::accel

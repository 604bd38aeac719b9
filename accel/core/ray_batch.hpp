#pragma once
// A list of rays for one query, and the pencils in it.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "accel/core/primary_rays.hpp"
#include "accel/core/ray.hpp"

namespace beambench::accel {

/// The rays [first, first + count) of a batch. Up to rounding, their lines pass through one common
/// point. Neighbors in the list are usually neighbors in the image.
struct Pencil {
  std::size_t first;
  std::size_t count;
  /// A point light, or the virtual eye of a planar mirror.
  glm::dvec3 apex;
  /// Whether the rays run toward the apex, which is at t = 1, and end there or slightly before it,
  /// as shadow rays do: t in [0, t_max]. Otherwise they run away from the apex, t in [0, infinity],
  /// and begin at some distance from it, as reflected rays begin at the mirror. A ray may have a
  /// shorter interval, such as a shadow ray that continues behind glass; structures must not return
  /// hits beyond it.
  bool toward;
  /// The image seen from the apex (`PrimaryRays::mirrored`) that has the rays of the samples listed
  /// in `RayBatch::samples`: the same lines up to rounding, with other origins and direction
  /// lengths. Null if there is no such image. Lives as long as the batch.
  const PrimaryRays* view = nullptr;
};

/// The pencils of one extended light, such as the samples of an area light: the pencils [first,
/// first + count) of a batch, consecutive in its list. All are `toward`, and their apexes lie close
/// together. Their rays begin at the same origins in the same order, at t = 0, and end at the apex
/// or at most `surface_lift` before it. So whatever all rays from an origin to the apexes hit, or
/// all miss, needs to be found only once.
struct PencilBundle {
  std::size_t first;
  std::size_t count;

  friend bool operator==(const PencilBundle&, const PencilBundle&) = default;
};

/// The rays [first, first + count) of a batch, which come from the eye of its image through the
/// same planes; at least one plane refracted them. They have no common point, but neighboring
/// samples have neighboring rays. None of them is also in a pencil.
struct RefractedRays {
  std::size_t first;
  std::size_t count;

  friend bool operator==(const RefractedRays&, const RefractedRays&) = default;
};

/// Further marks of a batch; like pencils, they are hints. Later versions of the interface may add
/// members at the end without recompiling structures.
struct BatchMarks {
  std::vector<PencilBundle> bundles;     ///< ordered by `first`; they do not overlap
  std::vector<RefractedRays> refracted;  ///< ordered by `first`; they do not overlap
};

/// Rays and the pencils among them, which are ordered by `first` and do not overlap. Pencils are
/// hints: a structure may ignore them. They change hits only within what `Conformance` allows, and
/// the rays are the same, bit for bit, with and without them.
struct RayBatch {
  std::span<const Ray> rays;
  std::span<const Pencil> pencils{};
  /// For each ray, the sample of `image` it came from, directly or via other rays, numbered as in a
  /// HitBuffer of the image; empty if the rays do not come from an image.
  std::span<const std::uint32_t> samples{};
  const PrimaryRays* image = nullptr;  ///< null if `samples` is empty
  const BatchMarks* marks = nullptr;   ///< null if there are none
};

}  // namespace beambench::accel

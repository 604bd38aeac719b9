#pragma once
// Traces parts of pencils through the hierarchy, compiled for several instruction sets.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "accel/core/beam_place.hpp"
#include "accel/core/hit_buffer.hpp"
#include "accel/core/ray.hpp"
#include "accel/core/ray_batch.hpp"
#include "accel/core/work_counters.hpp"
#include "accel/tile_beam/pencil_unit.hpp"
#include "accel/tile_beam/tile_hierarchy.hpp"

namespace beambench::accel::tile_beam {

/// The samples of an image from which rays come, as numbers in a HitBuffer.
struct PencilSamples {
  std::span<const std::uint32_t> of_rays;  ///< empty if unknown
  std::uint32_t width = 1;                 ///< of the image, in pixels
  std::uint32_t per_pixel = 1;
  double per_width = 1.0;  ///< 1 / width

  PencilSamples() = default;
  explicit PencilSamples(const RayBatch& batch) {
    if (batch.image == nullptr) return;
    of_rays = batch.samples;
    width = static_cast<std::uint32_t>(batch.image->width());
    per_pixel = static_cast<std::uint32_t>(batch.image->samples());
    per_width = 1.0 / width;
  }

  PencilSamples from(std::size_t first) const {
    PencilSamples rest = *this;
    if (!of_rays.empty()) rest.of_rays = of_rays.subspan(first);
    return rest;
  }
  /// Avoids a division. Half a pixel more than the quotient is far enough from whole numbers.
  std::uint32_t row_of(std::uint32_t pixel) const {
    return static_cast<std::uint32_t>((pixel + 0.5) * per_width);
  }
};

/// Rays of a pencil, at least one. The hierarchy is not empty.
struct PencilRays {
  const TileHierarchy& hierarchy;
  const scenes::Scene& scene;
  std::span<const Ray> rays;
  PencilSamples samples;
  glm::vec3 apex;
};

/// Origins of rays toward the apexes of a bundle. `PencilRays`: the rays toward the first one, but
/// their apex is the center of a ball that holds all.
struct BundleRays : PencilRays {
  static constexpr std::size_t kApexes = 16;

  float radius;  ///< of the ball
  /// The apexes, x, y, z, and as many copies of the last as there is room for.
  alignas(64) std::array<std::array<float, kApexes>, 3> places;
  std::size_t apexes;
  std::size_t stride;  ///< from a ray to the one from the same origin toward the next apex

  std::uint32_t all_apexes() const { return (1U << apexes) - 1U; }
  const Ray& ray(std::size_t origin, std::size_t apex) const {
    return rays.data()[origin + apex * stride];
  }
};

/// Means that the rays of an origin must be traced apex by apex. Otherwise what is found for an
/// origin is a bit for each apex: whether it is hidden.
inline constexpr std::uint32_t kOpen = 0x80000000U;

/// The result of a ray that is left to the query for single rays: its line is too long for float,
/// or has no direction from the apex.
inline constexpr std::uint8_t kUndecided = 2;
/// The same as the t of a closest hit; no ray has one there.
inline constexpr float kUndecidedT = -kInfinity;

/// The number of rays answered, and whether some of them are undecided.
struct AnsweredRays {
  std::size_t count;
  bool some_undecided;
};

/// The queries under one counting policy. They trace the first rays of a list, as many as fit into
/// `unit`. The unit's side of the cube is tried first, and is set to the one that saw the last
/// rays.
template <class Counting>
struct PencilQueries {
  /// Traces rays toward the apex: writes 1, 0 or kUndecided for each.
  AnsweredRays (*any_hits)(const PencilRays&, PencilUnit& unit, std::span<std::uint8_t> hits,
                           Counting&);
  /// Traces rays away from the apex: writes their hits from `first` of the buffer on; t is
  /// kUndecidedT if undecided.
  AnsweredRays (*closest_hits)(const PencilRays&, PencilUnit& unit, const HitSpan& buffer,
                               std::size_t first, Counting&);
  /// Writes which apexes are hidden from each origin of a bundle, or kOpen where its rays must be
  /// traced apex by apex.
  AnsweredRays (*bundle)(const BundleRays&, PencilUnit& unit, std::span<std::uint32_t> found,
                         Counting&);
};

struct PencilKernels : PencilQueries<NoCounting>, PencilQueries<WorkCounters> {
  /// Returns how many rays the queries trace at once.
  std::size_t (*count_part)(const PencilRays&, PencilUnit& unit);
  /// Writes the places of the rays of a part toward the apex when any_hits traces them
  /// (`note_places`); those that it leaves undecided are not written.
  void (*places)(const PencilRays&, PencilUnit& unit, std::span<BeamPlace> places);

  template <class Counting>
  const PencilQueries<Counting>& queries() const {
    return *this;
  }
};

/// Returns the kernels for the best instruction set that this machine has among some, like
/// `tile_kernels_for`.
const PencilKernels& pencil_kernels_for(std::int64_t targets);

}  // namespace beambench::accel::tile_beam

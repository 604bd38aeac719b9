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

/// The image samples that rays come from, numbered as in a HitBuffer.
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
  /// Returns the row of a pixel without a division. Adding half a pixel keeps the quotient far
  /// enough from integers.
  std::uint32_t row_of(std::uint32_t pixel) const {
    return static_cast<std::uint32_t>((pixel + 0.5) * per_width);
  }
};

/// Rays of a pencil, at least one. The hierarchy must not be empty.
struct PencilRays {
  const TileHierarchy& hierarchy;
  const scenes::Scene& scene;
  std::span<const Ray> rays;
  PencilSamples samples;
  glm::vec3 apex;
};

/// Origins of rays toward the apexes of a bundle. The `PencilRays` are those toward the first apex,
/// but with the center of a ball that contains all apexes as their apex.
struct BundleRays : PencilRays {
  static constexpr std::size_t kApexes = 16;

  float radius;  ///< of the ball
  /// The apexes' x, y and z, padded with copies of the last one.
  alignas(64) std::array<std::array<float, kApexes>, 3> places;
  std::size_t apexes;
  std::size_t stride;  ///< between rays from one origin toward consecutive apexes

  std::uint32_t all_apexes() const { return (1U << apexes) - 1U; }
  const Ray& ray(std::size_t origin, std::size_t apex) const {
    return rays.data()[origin + apex * stride];
  }
};

/// Marks an origin whose rays must be traced apex by apex. Otherwise the result for an origin has a
/// bit for each apex that is hidden.
inline constexpr std::uint32_t kOpen = 0x80000000U;

/// The result of a ray that is left to the single-ray query: its line is too long for float or has
/// no direction from the apex.
inline constexpr std::uint8_t kUndecided = 2;
/// The corresponding t of a closest hit, which no ray can have.
inline constexpr float kUndecidedT = -kInfinity;

/// The number of rays processed, and whether some of them are undecided.
struct AnsweredRays {
  std::size_t count;
  bool some_undecided;
};

/// The queries under one counting policy. They trace the first rays of a list, as many as fit into
/// `unit`. The unit's side of the cube is tried first and is set to the side that saw the last
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
  /// Writes which apexes are hidden from each origin of a bundle, or kOpen if its rays must be
  /// traced apex by apex.
  AnsweredRays (*bundle)(const BundleRays&, PencilUnit& unit, std::span<std::uint32_t> found,
                         Counting&);
};

struct PencilKernels : PencilQueries<NoCounting>, PencilQueries<WorkCounters> {
  /// Returns how many rays the queries trace at once.
  std::size_t (*count_part)(const PencilRays&, PencilUnit& unit);
  /// Writes the places of a part's rays toward the apex as any_hits traces them (`note_places`);
  /// undecided rays are not written.
  void (*places)(const PencilRays&, PencilUnit& unit, std::span<BeamPlace> places);

  template <class Counting>
  const PencilQueries<Counting>& queries() const {
    return *this;
  }
};

/// Returns the kernels for this machine's best instruction set among `targets`, like
/// `tile_kernels_for`.
const PencilKernels& pencil_kernels_for(std::int64_t targets);

}  // namespace beambench::accel::tile_beam

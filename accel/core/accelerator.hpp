#pragma once
// The contract of a structure.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "accel/core/beam_outline.hpp"
#include "accel/core/beam_place.hpp"
#include "accel/core/hit_buffer.hpp"
#include "accel/core/overlap.hpp"
#include "accel/core/primary_rays.hpp"
#include "accel/core/ray_batch.hpp"
#include "accel/core/statistics.hpp"
#include "accel/core/trace_step.hpp"
#include "accel/core/work_counters.hpp"

namespace beambench::accel {

/// A structure built over a scene. Queries are const and safe from several threads. The scene must
/// outlive it. Rays must pass `require_valid`.
///
/// A query adds the work it does to `counters`. In timed code the pointer is null and nothing is
/// counted: a structure has two instantiations of its traversal. By deriving from
/// `TraversalAccelerator` (traversal_accelerator.hpp) it gets both, the queries of many rays, and
/// `explain`.
///
/// Plug-ins hide their symbols, but derive from the one class that is in the program.
class [[gnu::visibility("default")]] Accelerator {
 public:
  Accelerator() = default;
  Accelerator(const Accelerator&) = delete;
  Accelerator& operator=(const Accelerator&) = delete;
  virtual ~Accelerator() = default;

  /// The nearest hit in [t_min, t_max], ties to the lowest primitive id.
  virtual std::optional<Hit> closest_hit(const Ray& ray, WorkCounters* counters) const = 0;
  /// Is there a hit in [t_min, t_max]?
  virtual bool any_hit(const Ray& ray, WorkCounters* counters) const = 0;
  /// The closest hits of a whole image. `buffer` has the size of `rays`.
  virtual void trace(const PrimaryRays& rays, HitBuffer& buffer, WorkCounters* counters) const = 0;
  /// The closest hits of a list of rays. `buffer` has its size.
  virtual void closest_hits(const RayBatch& batch, HitBuffer& buffer, WorkCounters* counters)
      const = 0;
  /// For each ray of a list: is there a hit (1) or none (0)? `hits` has its size.
  virtual void any_hits(const RayBatch& batch, std::span<std::uint8_t> hits, WorkCounters* counters)
      const = 0;

  /// `trace`, shared among the threads of the TBB arena that calls it (`trace_on` makes one): the
  /// same hits and counters for any number of them. Here row by row, each ray by `closest_hit`.
  virtual void trace_shared(const PrimaryRays& rays, HitBuffer& buffer, WorkCounters* counters)
      const;

  /// The traversal path of `closest_hit`, step by step; empty where the structure records none.
  virtual std::vector<TraceStep> explain(const Ray&) const { return {}; }

  /// The beams of an image in the order in which they are traced; empty where the structure has
  /// none.
  virtual std::vector<BeamOutline> beam_outlines(const PrimaryRays&) const { return {}; }
  /// Where each ray of an image (as a HitBuffer numbers them) is when `trace` traces it, and each
  /// ray of a batch when `any_hits` does; empty where the structure has no blocks of rays.
  virtual std::vector<BeamPlace> beam_places(const PrimaryRays&) const { return {}; }
  virtual std::vector<BeamPlace> beam_places(const RayBatch&) const { return {}; }
  /// The cells that hold references, in scene units; empty where the structure has no cells.
  virtual std::vector<Box> occupied_cells() const { return {}; }

  virtual Statistics statistics() const = 0;
};

}  // namespace beambench::accel

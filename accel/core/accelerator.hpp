#pragma once
// The contract of a structure.

#include <cstdint>
#include <optional>
#include <span>

#include "accel/core/hit_buffer.hpp"
#include "accel/core/inspector.hpp"
#include "accel/core/ray_source.hpp"
#include "accel/core/statistics.hpp"
#include "accel/core/work_counters.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel {

/// The arguments of a query besides its rays.
struct QueryContext {
  /// Counters that the query adds its work to. Null in timed code, which counts nothing; a
  /// structure instantiates its traversal with and without counting.
  WorkCounters* counters = nullptr;
  /// The maximum number of threads that share the rays of an image or of a batch (`thread_count`;
  /// 0: the default number). A structure may use fewer. Hits and counters do not depend on the
  /// number, except for counters of time.
  int threads = 1;
};

/// A structure built over a scene. Queries are const and safe from several threads. The scene must
/// outlive the structure. Rays must pass `require_valid`. The rays and primitives that a structure
/// supports are registered with it (`StructureInfo::support`).
///
/// By deriving from `TraversalAccelerator` (traversal_accelerator.hpp) a structure gets the queries
/// and the paths of an inspector from one traversal of single rays; a wrapper derives from
/// `ForwardingAccelerator` (forwarding_accelerator.hpp).
///
/// Visible by default: plug-ins hide their symbols but must derive from the program's class.
class [[gnu::visibility("default")]] Accelerator {
 public:
  Accelerator() = default;
  Accelerator(const Accelerator&) = delete;
  Accelerator& operator=(const Accelerator&) = delete;
  virtual ~Accelerator() = default;

  /// Finds the closest hit of each ray in [t_min, t_max]; ties go to the lowest primitive id.
  /// `hits` has the size of the source and, for an image, its shape. Throws if the structure cannot
  /// trace the rays now; for example, InputError if building on demand exceeds a limit.
  virtual void closest_hits(const RaySource& rays, const HitSpan& hits, const QueryContext& context)
      const = 0;
  /// Writes for each ray whether it has a hit in [t_min, t_max]: 1 or 0. `hits` has the size of the
  /// source. Throws like `closest_hits`.
  virtual void any_hits(const RaySource& rays, std::span<std::uint8_t> hits,
                        const QueryContext& context) const = 0;
  /// Returns the current sizes of the structure, which queries may divide further.
  virtual Statistics statistics() const = 0;

  /// Returns the object that shows paths, cells and beams; null if the structure has none. The
  /// object lives as long as the structure.
  virtual const Inspector* inspector() const { return nullptr; }

  /// Adapts the structure to its scene after coordinates have changed in place: `scene` is the
  /// scene it was built over, with the same primitives. No query may run meanwhile. Returns false,
  /// without any change, if the structure must be rebuilt.
  virtual bool update(const scenes::Scene& /*scene*/) { return false; }

  /// Runs `closest_hits` for one ray.
  std::optional<Hit> closest_hit(const Ray& ray, WorkCounters* counters = nullptr) const {
    Hit hit{kInfinity, scenes::kNoPrimitive};
    closest_hits(ray, HitSpan(hit), {counters});
    if (hit.primitive == scenes::kNoPrimitive) return std::nullopt;
    return hit;
  }
  /// Runs `any_hits` for one ray.
  bool any_hit(const Ray& ray, WorkCounters* counters = nullptr) const {
    std::uint8_t hit = 0;
    any_hits(ray, {&hit, 1}, {counters});
    return hit != 0;
  }
};

}  // namespace beambench::accel

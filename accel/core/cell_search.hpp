#pragma once
// Testing what the cells along a ray refer to: the part that octrees and grids have in common.

#include <optional>
#include <span>

#include "accel/core/intersect.hpp"
#include "accel/core/work_counters.hpp"

namespace beambench::accel {

/// Tests every reference, also one that an earlier cell of the ray had.
struct NoMailboxes {
  NoMailboxes() = default;
  explicit NoMailboxes(std::size_t /*primitives*/) {}
  static constexpr bool is_first(scenes::PrimitiveId) { return true; }
};

/// Tests the references of a cell for hits nearer than the closest so far. Is the closest hit
/// before the ray leaves the cell? Strictly: a hit at the exit's own rounded t may lie behind it
/// and have a lower id.
template <class Counting, class Mailboxes = const NoMailboxes&>
bool test_references(const scenes::Scene& scene, std::span<const scenes::PrimitiveId> references,
                     double exit_t, Counting& counting, ClosestHit& closest,
                     Mailboxes&& mailboxes = {}) {
  for (const scenes::PrimitiveId id : references) {
    if (!mailboxes.is_first(id)) continue;
    counting.add(Counter::kPrimitiveTests);
    counting.tested(id, closest.test(scene, id));
  }
  return closest.ray.t_max < static_cast<float>(exit_t);
}

/// The closest hit in the cells along a ray. `walk(visit)` calls `visit(references, exit_t)` for
/// the cells in order, until that returns true. A cell's references are the primitives that reach
/// into it, widened by `overlap_tolerance`. `mailboxes.is_first(id)` is called once for every
/// reference; it may be false only where the primitive was tested against this ray before.
template <class Counting, class Mailboxes, class Walk>
std::optional<Hit> closest_in_cells(const scenes::Scene& scene, const Ray& ray, Counting& counting,
                                    Mailboxes&& mailboxes, const Walk& walk) {
  ClosestHit closest(ray);
  walk([&](std::span<const scenes::PrimitiveId> references, double exit_t) {
    return test_references(scene, references, exit_t, counting, closest, mailboxes);
  });
  return closest.result();
}

/// Is there a hit in the cells along a ray? Parameters as of `closest_in_cells`.
template <class Counting, class Mailboxes, class Walk>
bool any_in_cells(const scenes::Scene& scene, const Ray& ray, Counting& counting,
                  Mailboxes&& mailboxes, const Walk& walk) {
  const CanonicalRay canonical(ray);
  bool found = false;
  walk([&](std::span<const scenes::PrimitiveId> references, double exit_t) {
    for (const scenes::PrimitiveId id : references) {
      if (!mailboxes.is_first(id)) continue;
      counting.add(Counter::kPrimitiveTests);
      found = is_hit(intersect(canonical, scene, id));
      if (found) return true;
    }
    return canonical.t_max < static_cast<float>(exit_t);
  });
  return found;
}

}  // namespace beambench::accel

#pragma once
// Tests the references of the cells along a ray; shared by octrees and grids.

#include <optional>
#include <span>

#include "accel/core/intersect.hpp"
#include "accel/core/work_counters.hpp"

namespace beambench::accel {

/// Tests every reference, even of primitives already tested in an earlier cell.
struct NoMailboxes {
  NoMailboxes() = default;
  explicit NoMailboxes(std::size_t /*primitives*/) {}
  static constexpr bool is_first(scenes::PrimitiveId) { return true; }
};

/// Tests the references of a cell (the primitives that overlap it when widened by
/// `overlap_tolerance`) for hits nearer than the closest so far. Returns whether the closest hit
/// lies strictly before the ray's exit from the cell. (If its t equals the exit's, a hit beyond the
/// exit may round to the same t and have a lower id.) `mailboxes.is_first(id)` is called once for
/// every reference; it may be false only if the primitive was already tested against this ray.
template <class Counting, class Mailboxes = const NoMailboxes&>
bool test_references(const scenes::Scene& scene, std::span<const scenes::PrimitiveId> references,
                     double exit_t, Counting& counting, ClosestHit& closest,
                     Mailboxes&& mailboxes = {}) {
  for (const scenes::PrimitiveId id : references) {
    if (!mailboxes.is_first(id)) continue;
    counting.add_tests(scene.primitives[id].kind);
    counting.tested(id, closest.test(scene, id));
  }
  return closest.ray.t_max < static_cast<float>(exit_t);
}

/// Returns whether the ray hits one of the references of a cell. `canonical` is that ray.
template <class Counting, class Mailboxes = const NoMailboxes&>
bool any_reference_hit(const scenes::Scene& scene, std::span<const scenes::PrimitiveId> references,
                       const CanonicalRay& canonical, Counting& counting,
                       Mailboxes&& mailboxes = {}) {
  for (const scenes::PrimitiveId id : references) {
    if (!mailboxes.is_first(id)) continue;
    counting.add_tests(scene.primitives[id].kind);
    if (is_hit(intersect(canonical, scene, id))) return true;
  }
  return false;
}

}  // namespace beambench::accel

#pragma once
// Finds where rays cross primitives by exact arithmetic, to settle disputes. Shares no code with
// the structures or the oracle. Slow: 20 ns for each primitive, and 10 us for each whose box the
// ray reaches.

#include <vector>

#include "accel/core/ray.hpp"
#include "accel/oracle/oracle.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// A place where the line of a ray crosses a primitive.
struct Crossing {
  double t;  ///< the exact value, rounded
  scenes::PrimitiveId primitive;
  bool leaving;  ///< whether the ray leaves the sphere or cone there; false for polygons

  accel::oracle::ExactHit hit() const { return {t, primitive}; }
};

/// Returns the primitives whose boxes the ray reaches, in ascending order. They include all
/// primitives that it crosses, and all whose boundary, or whose crossing just beyond an end of the
/// interval, is within the judge's tolerance.
std::vector<scenes::PrimitiveId> primitives_near(const scenes::Scene& scene, const accel::Ray& ray);

/// Returns the crossings of the ray's infinite line with one primitive, in any order. Floats are
/// treated as exact numbers, and integers decide whether there is a crossing. Polygons are closed
/// triangles, seen from both sides; a ray in a triangle's plane does not cross it. A sphere or cone
/// that the ray only touches is crossed twice, at one place.
std::vector<Crossing> line_crossings(const scenes::Scene& scene, const accel::Ray& ray,
                                     scenes::PrimitiveId id);

/// Returns the crossings of some primitives in the ray's interval (`accel::in_interval`), ordered
/// by t and, at equal t, by primitive.
std::vector<Crossing> crossings(const scenes::Scene& scene, const accel::Ray& ray,
                                const std::vector<scenes::PrimitiveId>& ids);

}  // namespace beambench::verify

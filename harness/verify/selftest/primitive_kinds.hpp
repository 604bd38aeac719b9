#pragma once
// Which primitives a structure takes.

#include <string>
#include <vector>

#include "accel/core/registry.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// Some of the kinds of primitives.
struct PrimitiveKinds {
  bool spheres = true;
  bool cones = true;
  bool polygons = true;

  bool all() const { return spheres && cones && polygons; }
  bool none() const { return !spheres && !cones && !polygons; }
  bool include(scenes::PrimitiveKind kind) const;
  /// Is the scene made of nothing else?
  bool include(const scenes::Scene& scene) const;
  /// `spheres`, `cones`, `polygons`: those of them.
  std::vector<std::string> names() const;
  /// The others.
  PrimitiveKinds without() const { return {!spheres, !cones, !polygons}; }
};

/// The kinds that a structure takes: those over a single primitive of which it is not refused by an
/// InputError. All of them where it refuses each, for then its kinds are not what it refuses.
PrimitiveKinds kinds_taken(const accel::StructureChoice& choice);

}  // namespace beambench::verify

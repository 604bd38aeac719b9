#pragma once
// The structure that a self-test is about, and the primitives that it takes.

#include <memory>
#include <string_view>
#include <vector>

#include "accel/core/registry.hpp"
#include "scenes/base/random.hpp"
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
  std::vector<std::string_view> names() const;
  /// The others.
  PrimitiveKinds without() const { return {!spheres, !cones, !polygons}; }
};

/// The kinds that a structure takes: those over a single primitive of which it is not refused by an
/// InputError. All of them where it refuses each, for then its kinds are not what it refuses.
PrimitiveKinds kinds_taken(const accel::StructureChoice& choice);

/// Values near the lower end of each parameter's range, where structures are forced to their
/// special cases; defaults for reals and for large caps.
Parameters random_parameters(const accel::StructureInfo& info, Random& random);

/// A structure with the given parameters. Where none are given, some scenes get random ones.
class Subject {
 public:
  /// Builds it over three tiny scenes, to see which primitives it takes.
  explicit Subject(accel::StructureChoice choice)
      : choice_(std::move(choice)), kinds_(kinds_taken(choice_)) {}

  const accel::StructureInfo& info() const { return choice_.info(); }
  accel::Conformance conformance() const { return info().conformance; }
  const accel::StructureChoice& choice() const { return choice_; }
  /// What the scenes of the checks are made of.
  PrimitiveKinds kinds() const { return kinds_; }
  /// With parameters of its own for each call, if it may.
  accel::StructureChoice vary(Random& random) const;

  std::unique_ptr<accel::Accelerator> build(const scenes::Scene& scene) const {
    return choice_.build(scene);
  }

 private:
  accel::StructureChoice choice_;
  PrimitiveKinds kinds_;
};

}  // namespace beambench::verify

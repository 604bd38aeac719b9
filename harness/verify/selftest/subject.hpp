#pragma once
// The structure under test, and the primitives that it supports.

#include <memory>
#include <string_view>
#include <vector>

#include "accel/core/registry.hpp"
#include "scenes/base/random.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// A set of kinds of primitives.
struct PrimitiveKinds {
  bool spheres = true;
  bool cones = true;
  bool polygons = true;

  bool all() const { return spheres && cones && polygons; }
  bool none() const { return !spheres && !cones && !polygons; }
  bool include(scenes::PrimitiveKind kind) const;
  /// Returns whether the scene consists only of these kinds.
  bool include(const scenes::Scene& scene) const;
  /// Returns the names of the kinds in the set: `spheres`, `cones`, `polygons`.
  std::vector<std::string_view> names() const;
  /// Returns the other kinds.
  PrimitiveKinds without() const { return {!spheres, !cones, !polygons}; }
};

/// Returns the kinds that a structure supports: those for which building over a single primitive
/// throws no InputError. Returns all kinds if every build throws, because then the kinds are not
/// the reason.
PrimitiveKinds kinds_taken(const accel::StructureChoice& choice);

/// Returns values near the lower end of each parameter's range, which force structures into their
/// special cases. Real parameters and large caps keep their defaults.
Parameters random_parameters(const accel::StructureInfo& info, Random& random);

/// A structure with the given parameters. If no parameters are given, some scenes use random ones.
class Subject {
 public:
  /// Builds the structure over three tiny scenes, to determine which primitives it supports.
  explicit Subject(accel::StructureChoice choice)
      : choice_(std::move(choice)), kinds_(kinds_taken(choice_)) {}
  Subject(accel::StructureChoice choice, PrimitiveKinds kinds)
      : choice_(std::move(choice)), kinds_(kinds) {}

  const accel::StructureInfo& info() const { return choice_.info(); }
  accel::Conformance conformance() const { return info().conformance; }
  const accel::StructureChoice& choice() const { return choice_; }
  /// Returns the kinds of primitives in the scenes of the checks.
  PrimitiveKinds kinds() const { return kinds_; }
  /// Returns the structure, with different parameters for each call if allowed.
  accel::StructureChoice vary(Random& random) const;

  std::unique_ptr<accel::Accelerator> build(const scenes::Scene& scene) const {
    return choice_.build(scene);
  }

 private:
  accel::StructureChoice choice_;
  PrimitiveKinds kinds_;
};

}  // namespace beambench::verify

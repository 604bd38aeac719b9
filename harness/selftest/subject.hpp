#pragma once
// The structure that a self-test is about.

#include <memory>

#include "accel/registry.hpp"
#include "harness/selftest/primitive_kinds.hpp"
#include "scenes/random.hpp"

namespace beambench {

/// Values near the lower end of each parameter's range, where structures are forced to their
/// special cases; defaults for reals and for large caps.
Parameters random_parameters(const StructureInfo& info, Random& random);

/// A structure with the parameters that were asked for. Where none were, some scenes get random
/// ones.
class Subject {
 public:
  /// Builds it over three tiny scenes, to see which primitives it takes.
  explicit Subject(StructureChoice choice)
      : choice_(std::move(choice)), kinds_(kinds_taken(choice_)) {}

  const StructureInfo& info() const { return choice_.info(); }
  Conformance conformance() const { return info().conformance; }
  const StructureChoice& choice() const { return choice_; }
  /// What the scenes that it is asked over are made of.
  PrimitiveKinds kinds() const { return kinds_; }
  /// With parameters of its own for each call, if it may.
  StructureChoice vary(Random& random) const;

  std::unique_ptr<Accelerator> build(const Scene& scene) const { return choice_.build(scene); }

 private:
  StructureChoice choice_;
  PrimitiveKinds kinds_;
};

}  // namespace beambench

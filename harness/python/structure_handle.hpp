#pragma once
// A structure shared by Python objects and long-running work.

#include <memory>
#include <string>

#include "accel/core/accelerator.hpp"
#include "accel/core/registry.hpp"
#include "scenes/scene.hpp"

namespace beambench::python {

/// A structure, and the objects that it refers to.
struct BuiltStructure {
  std::shared_ptr<const scenes::Scene> scene;
  accel::StructureChoice choice;
  std::unique_ptr<const accel::Accelerator> accelerator;
  int threads;  ///< it was built for, to trace images; see `accel::thread_count`
                ///< `accel::thread_count`
};

struct StructureHandle {
  std::shared_ptr<const BuiltStructure> built;
};

/// Builds a structure. Throws what `accel::Registry::choose` and `accel::StructureChoice::build`
/// throw.
StructureHandle build(std::shared_ptr<const scenes::Scene> scene, const std::string& spec,
                      int threads);

}  // namespace beambench::python

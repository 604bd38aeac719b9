#pragma once
// The registry's other door, for the loader of plug-ins alone.

#include <vector>

#include "accel/core/registry.hpp"

namespace beambench::accel {

/// Adds structures to `registry()`. Choices point into it, so this is for the time before the first
/// one is made. The structures were checked (harness/plugin/check_contents.hpp).
void extend_registry(std::vector<StructureInfo> structures);

}  // namespace beambench::accel

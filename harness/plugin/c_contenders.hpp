#pragma once
// Structures of shared objects that export the C interface (contender.h).

#include <string>
#include <vector>

#include "accel/core/registry.hpp"
#include "harness/plugin/c/beambench/contender.h"

namespace beambench::plugin {

/// Returns the structures in the tables of a shared object. Throws PluginError with the problem: no
/// tables of this version of the interface, or a table without its size, strings or functions.
std::vector<accel::StructureInfo> structures_of(decltype(&beambench_contenders) contenders);

}  // namespace beambench::plugin

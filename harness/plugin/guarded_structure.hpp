#pragma once
// A plug-in's structure as the program sees it.

#include <memory>

#include "accel/core/registry.hpp"
#include "harness/plugin/activity.hpp"

namespace beambench::plugin {

/// The same structure, built under watch: what it is at stands in `activity`, what it throws
/// becomes a PluginError that names it, and so do a structure that was not built, and single hits
/// that cannot be (answers to whole images and lists of rays are left to the differ: nothing is
/// between them and the structure but this one call). `activity` outlives the program's use of it.
accel::StructureInfo guarded(accel::StructureInfo info, Activity& activity);

}  // namespace beambench::plugin

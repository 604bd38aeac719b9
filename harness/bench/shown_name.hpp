#pragma once
// Names of cells as people read them while a sweep runs.

#include <string>

#include "harness/bench/record/cell_record.hpp"

namespace beambench::bench {

/// `CellId::name` without the parameters of the scene and the structure that are at their defaults,
/// which would fill lines: `escena1/default/320x200/1/primary/samet:max_level=6`.
std::string shown_name(const CellId& id);

/// A scene's name in the same way: `tetra:n=4`, or `tetra` for `tetra:n=6`. A path stays as it is.
std::string shown_scene(const std::string& scene);

}  // namespace beambench::bench

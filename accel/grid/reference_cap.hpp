#pragma once
// The cap on a grid's lists.

#include <cstdint>

#include "accel/core/cell_grid.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::grid {

/// Throws the InputError of a grid whose voxels refer to more than `max_references` primitives.
[[noreturn]] void fail_too_many_references(const scenes::Scene& scene, const CellGrid& grid,
                                           std::uint64_t max_references);

}  // namespace beambench::accel::grid

#include "accel/grid/reference_cap.hpp"

#include <fmt/format.h>

#include "scenes/core/error.hpp"

namespace beambench::accel::grid {

void fail_too_many_references(const scenes::Scene& scene, const CellGrid& grid,
                              std::uint64_t max_references) {
  throw InputError(fmt::format(
      "the grid of {}x{}x{} voxels over '{}' ({} primitives) holds more than {} references; lower "
      "resolution (or density), or raise max_references (4 bytes each)",
      grid.cells.x, grid.cells.y, grid.cells.z, scene.name, scene.primitives.size(),
      max_references));
}

}  // namespace beambench::accel::grid

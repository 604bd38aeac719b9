#include "accel/grid/grid_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "accel/core/tolerance.hpp"
#include "accel/grid/voxel_walk.hpp"
#include "scenes/base/error.hpp"

namespace beambench::accel::grid {
namespace {

glm::ivec3 cubic_cells(const glm::dvec3& size, double wanted, int most) {
  glm::ivec3 cells(1);
  std::array<bool, 3> is_short{};
  for (int attempt = 0; attempt < 3; ++attempt) {
    double volume = 1.0;
    int axes = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (is_short[static_cast<std::size_t>(axis)]) continue;
      volume *= size[axis];
      ++axes;
    }
    if (axes == 0) break;
    const double edge = std::pow(volume / wanted, 1.0 / axes);
    bool settled = true;
    for (int axis = 0; axis < 3; ++axis) {
      const auto slot = static_cast<std::size_t>(axis);
      if (is_short[slot]) continue;
      if (!(size[axis] >= edge) || size[axis] == 0.0) {
        is_short[slot] = true;
        cells[axis] = 1;
        settled = false;
      } else {
        cells[axis] = static_cast<std::int32_t>(
            std::clamp(std::round(size[axis] / edge), 1.0, static_cast<double>(most)));
      }
    }
    if (settled) break;
  }
  return cells;
}

/// Returns an upper estimate of the references in a grid of `cells`. A surface overlaps all voxels
/// of its bounds or, if those are many, about twice as many as lie on the sides of its bounds.
double estimated_references(const scenes::Scene& scene, const glm::dvec3& size,
                            const glm::ivec3& cells, Assign assign) {
  const glm::dvec3 voxels_per_unit = glm::dvec3(cells) / glm::max(size, glm::dvec3(1e-300));
  double references = 0.0;
  for (scenes::PrimitiveId id = 0; id < scene.primitives.size(); ++id) {
    const glm::dvec3 extent(scenes::primitive_bounds(scene, id).extent());
    const glm::dvec3 n = glm::min(extent * voxels_per_unit + 1.0, glm::dvec3(cells));
    const double in_box = n.x * n.y * n.z;
    const double on_sides = 2.0 * (n.x * n.y + n.y * n.z + n.z * n.x);
    references += assign == Assign::kBounds ? in_box : std::min(in_box, on_sides);
  }
  return references;
}

glm::ivec3 automatic_cells(const scenes::Scene& scene, const glm::dvec3& size,
                           const GridLayout& layout) {
  double wanted = std::clamp(layout.density * static_cast<double>(scene.primitives.size()), 1.0,
                             static_cast<double>(layout.max_voxels));
  const auto cells_of = [&] {
    return cells_by_number(size, std::max(wanted, 1.0), layout.shape, kMaxCellsPerAxis);
  };
  glm::ivec3 cells = cells_of();
  while (wanted > 1.0 && estimated_references(scene, size, cells, layout.assign) >
                             static_cast<double>(layout.max_references)) {
    wanted /= 2.0;
    cells = cells_of();
  }
  return cells;
}

}  // namespace

glm::ivec3 cells_by_number(const glm::dvec3& size, double wanted, Shape shape, int most) {
  if (shape == Shape::kCubic) return cubic_cells(size, wanted, most);
  return glm::ivec3(
      static_cast<int>(std::clamp(std::round(std::cbrt(wanted)), 1.0, static_cast<double>(most))));
}

CellGrid make_voxel_grid(const scenes::Scene& scene, const GridLayout& layout) {
  glm::dvec3 size(0.0);
  if (!scene.bounds.empty()) size = glm::dvec3(scene.bounds.upper) - glm::dvec3(scene.bounds.lower);
  glm::ivec3 cells(1);
  if (layout.resolution) {
    const auto& given = *layout.resolution;
    cells = {given[0], given[1], given[2]};
  } else {
    cells = automatic_cells(scene, size, layout);
  }
  const std::int64_t voxels = std::int64_t{cells.x} * cells.y * cells.z;
  if (voxels > layout.max_voxels) {
    throw InputError(fmt::format(
        "resolution {}x{}x{} makes {} voxels, more than max_voxels {}; lower resolution, or raise "
        "max_voxels (4 bytes each, 8 if fill is lazy)",
        cells.x, cells.y, cells.z, voxels, layout.max_voxels));
  }
  // Hits lie within the tolerance of the bounds, so the grid must contain that margin.
  const double tolerance = overlap_tolerance(scene);
  const glm::dvec3 margin = glm::max(size * 1e-6, glm::dvec3(2.0 * tolerance));
  return make_cell_grid(scene.bounds, size, margin, cells);
}

void fail_too_many_references(const scenes::Scene& scene, const CellGrid& grid,
                              std::uint64_t max_references) {
  throw InputError(fmt::format(
      "the grid of {}x{}x{} voxels over '{}' ({} primitives) holds more than {} references; lower "
      "resolution (or density), or raise max_references (4 bytes each)",
      grid.cells.x, grid.cells.y, grid.cells.z, scene.name, scene.primitives.size(),
      max_references));
}

ParameterInfo resolution_parameter() {
  return cells_parameter("resolution", "auto", kMaxCellsPerAxis,
                         "voxels along the axes of the scene's box: one number for all three, "
                         "three numbers, or auto: by density, but fewer if the lists would "
                         "exceed max_references");
}

ParameterInfo density_parameter(double default_value) {
  return real_parameter("density", default_value, 0.001, 1000.0,
                        "voxels for each primitive of the scene, if resolution is auto");
}

ParameterInfo max_references_parameter(const GridLayout& defaults) {
  return integer_parameter("max_references", static_cast<std::int64_t>(defaults.max_references), 1,
                           2'000'000'000,
                           "stop with an error beyond this many references (4 bytes each)");
}

}  // namespace beambench::accel::grid

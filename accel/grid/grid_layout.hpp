#pragma once
// Lays a grid over a scene.

#include <array>
#include <cstdint>
#include <optional>

#include <glm/vec3.hpp>

#include "accel/core/cell_grid.hpp"
#include "accel/grid/assign.hpp"
#include "scenes/base/parameters.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::grid {

/// Voxels as cubic as possible, or the same number along each axis.
enum class Shape { kCubic, kEqual };

/// The layout of any structure with a grid over the scene's box.
struct GridLayout {
  std::optional<std::array<std::int32_t, 3>> resolution;  ///< voxels per axis; empty: by density
  double density = 4.0;                                   ///< voxels for each primitive
  Shape shape = Shape::kCubic;                            ///< shape of voxels laid out by density
  Assign assign = Assign::kSurface;
  std::int64_t max_voxels = 100'000'000;
  std::uint64_t max_references = 50'000'000;
};

/// Returns the number of voxels along each axis of a box of `size`, about `wanted` in total and at
/// most `most` per axis. With cubic voxels, an axis too short for a cubic voxel has one voxel, and
/// the other axes have more.
glm::ivec3 cells_by_number(const glm::dvec3& size, double wanted, Shape shape, int most);

/// Returns the grid over the scene's box. Throws an InputError that names `max_voxels` if the grid
/// has more voxels.
CellGrid make_voxel_grid(const scenes::Scene& scene, const GridLayout& layout);

/// Throws the InputError for a grid whose voxels refer to more than `max_references` primitives.
[[noreturn]] void fail_too_many_references(const scenes::Scene& scene, const CellGrid& grid,
                                           std::uint64_t max_references);

/// Return the common parameters of structures over a grid.
ParameterInfo resolution_parameter();
ParameterInfo density_parameter(double default_value);
ParameterInfo max_references_parameter(const GridLayout& defaults);

}  // namespace beambench::accel::grid

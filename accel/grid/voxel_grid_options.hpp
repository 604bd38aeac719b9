#pragma once
// How a grid of voxels is laid over a scene.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "accel/core/cell_grid.hpp"
#include "scenes/core/parameters.hpp"
#include "scenes/scene.hpp"

namespace beambench::accel::grid {

struct VoxelGridOptions {
  enum class Fill { kLazy, kEager };

  std::optional<std::array<std::int32_t, 3>> resolution;  ///< voxels per axis; nothing: by density
  double density = 4.0;                                   ///< voxels for each primitive
  Fill fill = Fill::kEager;
  bool mailboxes = false;
  std::int64_t max_voxels = 100'000'000;
  std::uint64_t max_references = 50'000'000;

  static std::vector<ParameterInfo> parameters();
  static VoxelGridOptions from(const Parameters& parameters);
};

/// The grid over the scene's own box. Throws InputError naming `max_voxels` when it has more.
CellGrid make_voxel_grid(const scenes::Scene& scene, const VoxelGridOptions& options);

/// Throws the InputError of a grid whose voxels refer to more than `max_references` primitives.
[[noreturn]] void fail_too_many_references(const scenes::Scene& scene, const CellGrid& grid,
                                           std::uint64_t max_references);

}  // namespace beambench::accel::grid

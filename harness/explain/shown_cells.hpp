#pragma once
// The cells or nodes of a structure, by level.

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "accel/core/accelerator.hpp"

namespace beambench::explain {

/// Some or all cells of a structure.
struct ShownCells {
  std::string_view kind = "nodes";  ///< the kind of the cells
  std::vector<accel::Cell> cells;
  std::size_t of = 0;  ///< the total number of cells
};

/// The maximum number of a structure's cells on a page.
inline constexpr std::size_t kMostCells = 20'000;

/// Returns the occupied cells of a structure; if it has none, the nodes of its hierarchy of boxes;
/// otherwise `visited`, the distinct places that rays entered. If there are more than `most`, keeps
/// every n-th.
ShownCells shown_cells(const accel::Accelerator& structure, std::span<const accel::Cell> visited,
                       std::size_t most = kMostCells);

}  // namespace beambench::explain

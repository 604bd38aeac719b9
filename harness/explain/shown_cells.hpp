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
  std::string_view kind = "nodes";  ///< what the cells are
  std::vector<accel::Cell> cells;
  std::size_t of = 0;  ///< how many there are in all
};

/// The most cells of a structure on a page.
inline constexpr std::size_t kMostCells = 20'000;

/// Returns the occupied cells of a structure, or else the nodes of its hierarchy of boxes, or else
/// `visited`, the distinct places that rays entered. Every n-th is kept where they are more than
/// `most`.
ShownCells shown_cells(const accel::Accelerator& structure, std::span<const accel::Cell> visited,
                       std::size_t most = kMostCells);

}  // namespace beambench::explain

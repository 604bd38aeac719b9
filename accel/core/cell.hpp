#pragma once
// A cell of a structure, for inspectors.

#include "accel/core/overlap.hpp"

namespace beambench::accel {

/// A cell or node of a structure.
struct Cell {
  Box box;        ///< in scene units
  int level = 1;  ///< the root has level 1
};

}  // namespace beambench::accel

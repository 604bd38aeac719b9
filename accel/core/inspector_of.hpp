#pragma once
// The inspector of any structure.

#include "accel/core/accelerator.hpp"

namespace beambench::accel {

/// Returns the inspector of a structure, or an inspector that shows nothing if the structure has
/// none.
inline const Inspector& inspector_of(const Accelerator& structure) {
  static const struct Nothing final : Inspector {
  } nothing;
  const Inspector* inspector = structure.inspector();
  return inspector != nullptr ? *inspector : nothing;
}

}  // namespace beambench::accel

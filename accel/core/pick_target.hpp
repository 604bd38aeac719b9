#pragma once
// Selects the Highway target that a kernel runs on, which is not always the best one.

#include <cstdint>
#include <type_traits>

#include <hwy/targets.h>

namespace beambench::accel {

/// Returns the entry of a HWY_DISPATCH_TABLE for the best of `targets` (from `targets_of`) that
/// this machine supports. HWY_DYNAMIC_DISPATCH would read a global variable.
template <class Table>
auto pick_target(const Table& table, std::int64_t targets) {
  if constexpr (std::extent_v<Table> == 1) {  // compiled for a single target
    return table[0];
  } else {
    hwy::ChosenTarget chosen;
    chosen.Update(hwy::SupportedTargets() & targets);
    return table[chosen.GetIndex()];
  }
}

}  // namespace beambench::accel

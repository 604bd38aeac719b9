#pragma once
// Selects which of Highway's targets a kernel runs on, where it is not always the best.

#include <cstdint>
#include <type_traits>

#include <hwy/targets.h>

namespace beambench::accel {

/// Returns the entry of a HWY_DISPATCH_TABLE for the best of `targets` (of `targets_of`) that this
/// machine has. HWY_DYNAMIC_DISPATCH would read a global variable.
template <class Table>
auto pick_target(const Table& table, std::int64_t targets) {
  if constexpr (std::extent_v<Table> == 1) {  // compiled for one target alone
    return table[0];
  } else {
    hwy::ChosenTarget chosen;
    chosen.Update(hwy::SupportedTargets() & targets);
    return table[chosen.GetIndex()];
  }
}

}  // namespace beambench::accel

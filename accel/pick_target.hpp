#pragma once
// Which of Highway's targets a kernel runs on, where not simply the best is wanted.

#include <cstddef>
#include <cstdint>

#include <hwy/targets.h>

namespace beambench {

/// The entry of a table of HWY_EXPORT for the best of `targets` (of `targets_of`) that this machine
/// has. HWY_DYNAMIC_DISPATCH would ask a global variable.
template <class Function, std::size_t size>
Function pick_target(const Function (&table)[size], std::int64_t targets) {
  if constexpr (size == 1) {  // compiled for one target alone
    return table[0];
  } else {
    hwy::ChosenTarget chosen;
    chosen.Update(hwy::SupportedTargets() & targets);
    return table[chosen.GetIndex()];
  }
}

}  // namespace beambench

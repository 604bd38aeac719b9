#pragma once
// Runs tests on every instruction set of this machine.

#include <cstdint>
#include <string>
#include <vector>

#include <hwy/targets.h>

#include "accel/core/instruction_set.hpp"

namespace beambench::tests {

/// Restricts Highway to one instruction set until destroyed.
class OnlyTarget {
 public:
  explicit OnlyTarget(std::int64_t target) { pretend(target); }
  ~OnlyTarget() { pretend(0); }
  OnlyTarget(const OnlyTarget&) = delete;
  OnlyTarget& operator=(const OnlyTarget&) = delete;

 private:
  static void pretend(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

/// Returns the values of the parameter `isa` that this machine supports.
inline std::vector<std::string> available_isas() {
  std::vector<std::string> available = accel::isa_parameter().choices;
  std::erase_if(available, [](const std::string& isa) { return !accel::is_available(isa); });
  return available;
}

}  // namespace beambench::tests

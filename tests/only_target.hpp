#pragma once
// Runs tests on every instruction set of this machine.

#include <cstdint>

#include <hwy/targets.h>

namespace beambench::tests {

/// Makes Highway believe that the machine has one instruction set, until destroyed.
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

}  // namespace beambench::tests

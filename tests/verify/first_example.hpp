#pragma once
// Output of a failed verification.

#include <string>

#include "harness/verify/describe.hpp"
#include "harness/verify/differ.hpp"

namespace beambench::tests {

/// Describes the first disputed ray; empty if there is none.
inline std::string first_example(const verify::ReferenceHits& reference,
                                 const verify::DiffReport& report) {
  return report.examples.empty()
             ? ""
             : verify::describe(reference.scene(), reference.input(), report.examples.front());
}

}  // namespace beambench::tests

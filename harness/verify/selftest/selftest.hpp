#pragma once
// What must be true of every structure, checked for one.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "harness/verify/selftest/subject.hpp"

namespace beambench::verify {

/// How hard it is tested. The same numbers give the same scenes and rays everywhere.
struct SelftestEffort {
  std::uint64_t seed = 1;
  std::uint64_t scenes = 60;  ///< random ones
};

struct CheckOutcome {
  std::uint64_t rays = 0;  ///< traced
  std::string failure;     ///< the first fault, in a sentence; empty: none

  bool passed() const { return failure.empty(); }
};

/// One property of structures.
struct Check {
  std::string_view name;
  std::string_view claim;  ///< what must be true
  bool bit_exact_only;     ///< not for structures with arithmetic of their own
  bool of_polygons;        ///< not for structures that refuse them
  CheckOutcome (*run)(const Subject& subject, const SelftestEffort& effort);
};

/// All of them, the quick and general ones first.
std::span<const Check> selftest_checks();

/// Does the check apply to that structure? None does to one that returns no hits by design.
bool applies(const Check& check, const Subject& subject);

/// Runs a check. What the structure throws is a failure, too.
CheckOutcome run_check(const Check& check, const Subject& subject, const SelftestEffort& effort);

}  // namespace beambench::verify

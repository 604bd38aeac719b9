#pragma once
// Checks of how a structure answers: whatever the answers are, asked again or otherwise they are
// the same, and what it says of itself can be.

#include "harness/verify/selftest/selftest.hpp"

namespace beambench::verify {

CheckOutcome check_lists(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_counting(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_two_builds(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_threads(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_counters(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_statistics(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_explanation(const Subject& subject, const SelftestEffort& effort);

}  // namespace beambench::verify

#pragma once
// The checks of the self-test.

#include <optional>
#include <string>

#include "harness/verify/selftest/selftest.hpp"

namespace beambench::verify {

/// With all its bits, so that it can be traced again.
std::string show(const accel::Ray& ray);
std::string show(const std::optional<accel::Hit>& hit);

CheckOutcome check_random_scenes(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_scene_families(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_images(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_smallest_scenes(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_faces_edges_corners(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_heap(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_degenerate_rays(const Subject& subject, const SelftestEffort& effort);

CheckOutcome check_lists(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_counting(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_two_builds(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_threads(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_counters(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_statistics(const Subject& subject, const SelftestEffort& effort);
CheckOutcome check_explanation(const Subject& subject, const SelftestEffort& effort);

}  // namespace beambench::verify

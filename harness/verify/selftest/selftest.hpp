#pragma once
// What must be true of every structure, checked for one.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "accel/core/registry.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/verify/diff_report.hpp"
#include "harness/verify/selftest/subject.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// How hard it is tested. The same numbers give the same scenes and rays everywhere.
struct SelftestEffort {
  std::uint64_t seed = 1;
  std::uint64_t scenes = 60;  ///< random ones, of each check that makes them
  std::uint64_t rays = 300;   ///< about so many for each of these
};

/// What a structure gets wrong hits for: what `minimize` starts from.
struct FailedInput {
  scenes::Scene scene;
  accel::StructureChoice structure;
  rays::TraceInput input;
  Mismatch wrong;  ///< of a ray of `input`
};

struct CheckOutcome {
  std::uint64_t rays = 0;               ///< traced
  std::string failure;                  ///< the first fault, in a sentence; empty: none
  std::optional<FailedInput> failed{};  ///< where it is a wrong hit

  bool passed() const { return failure.empty(); }
};

using RunCheck = CheckOutcome(const Subject& subject, const SelftestEffort& effort);

/// One property of structures.
struct Check {
  std::string_view name;
  std::string_view claim;  ///< what must be true
  bool bit_exact_only;     ///< not for structures with arithmetic of their own
  bool of_polygons;        ///< not for structures that refuse them
  RunCheck* run;
};

/// All of them, the quick and general ones first.
std::span<const Check> selftest_checks();

/// Does the check apply to that structure? None does to one that returns no hits by design.
bool applies(const Check& check, const Subject& subject);

/// Runs a check. What the structure throws is a failure, too.
CheckOutcome run_check(const Check& check, const Subject& subject, const SelftestEffort& effort);

/// With all its bits, so that it can be traced again.
std::string show(const accel::Ray& ray);
std::string show(const std::optional<accel::Hit>& hit);

/// The results for an input, in a buffer poisoned before: a result left unwritten is found.
rays::TraceResults traced(const accel::Accelerator& structure, const rays::TraceInput& input,
                          accel::WorkCounters* counters = nullptr);

/// Of hits.
RunCheck check_random_scenes, check_scene_families, check_views, check_images,
    check_smallest_scenes, check_faces_edges_corners, check_heap, check_degenerate_rays;
/// Of all else.
RunCheck check_lists, check_counting, check_two_builds, check_threads, check_counters,
    check_statistics, check_explanation;

}  // namespace beambench::verify

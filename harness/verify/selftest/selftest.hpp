#pragma once
// Checks whether a structure has the properties that every structure must have.

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

/// The effort of the test. The same numbers give the same scenes and rays everywhere.
struct SelftestEffort {
  std::uint64_t seed = 1;
  std::uint64_t scenes = 60;  ///< number of random scenes in each check that uses them
  std::uint64_t rays = 300;   ///< approximate number of rays for each of them
};

/// The input for which a structure returns wrong hits: the starting point of `minimize`.
struct FailedInput {
  scenes::Scene scene;
  accel::StructureChoice structure;
  rays::TraceInput input;
  Mismatch wrong;  ///< of a ray of `input`
};

struct CheckOutcome {
  std::uint64_t rays = 0;               ///< traced
  std::string failure;                  ///< the first fault, in a sentence; empty if there is none
  std::optional<FailedInput> failed{};  ///< set for wrong hits

  bool passed() const { return failure.empty(); }
};

using RunCheck = CheckOutcome(const Subject& subject, const SelftestEffort& effort);

/// The sources of rays that a check needs. It also uses other sources if the structure supports
/// them.
enum class NeededRays : std::uint8_t { kAny, kImages, kSingle, kSingleAndLists };

/// One property of structures.
struct Check {
  std::string_view name;
  std::string_view claim;  ///< the claim to be checked
  bool bit_exact_only;     ///< not for structures with their own arithmetic
  bool of_polygons;        ///< not for structures that do not support polygons
  NeededRays rays;         ///< not for structures that do not support these
  RunCheck* run;
};

/// Returns all checks, the quick and general ones first.
std::span<const Check> selftest_checks();

/// Returns whether the check applies to that structure. No check applies to a structure that
/// returns no hits by design.
bool applies(const Check& check, const Subject& subject);

/// Runs a check. An exception of the structure is also a failure.
CheckOutcome run_check(const Check& check, const Subject& subject, const SelftestEffort& effort);

/// Formats a ray with all its bits, so that it can be traced again.
std::string show(const accel::Ray& ray);
std::string show(const std::optional<accel::Hit>& hit);

/// Traces an input into a poisoned buffer, so that a result left unwritten is detected.
rays::TraceResults traced(const accel::Accelerator& structure, const rays::TraceInput& input,
                          accel::WorkCounters* counters = nullptr);

/// The checks of hits.
RunCheck check_random_scenes, check_scene_families, check_views, check_images,
    check_smallest_scenes, check_faces_edges_corners, check_closed_meshes, check_heap,
    check_degenerate_rays;
/// All other checks.
RunCheck check_lists, check_counting, check_two_builds, check_threads, check_counters,
    check_statistics, check_explanation;

}  // namespace beambench::verify

#pragma once
// The differ: verifies a structure's hits against the oracle, ray by ray.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "accel/core/registry.hpp"
#include "accel/oracle/oracle.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/verify/diff_report.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// Returns the hit with `t` rounded to float.
inline std::optional<accel::Hit> rounded(const std::optional<accel::oracle::ExactHit>& hit) {
  if (!hit) return std::nullopt;
  return accel::Hit{static_cast<float>(hit->t), hit->primitive};
}

/// Computes the oracle's closest hit of each ray on all cores. The oracle must reach as far as the
/// input (`TraceInput::reach`).
std::vector<std::optional<accel::oracle::ExactHit>> oracle_hits(const accel::oracle::Oracle& oracle,
                                                                const rays::TraceInput& input);

/// The oracle's closest hit of each ray of an input, computed once (on all cores) and used for
/// every contender. The scene must outlive this object.
class ReferenceHits {
 public:
  ReferenceHits(const scenes::Scene& scene, rays::TraceInput input);
  /// Uses hits from another source.
  ReferenceHits(const scenes::Scene& scene, rays::TraceInput input,
                std::vector<std::optional<accel::oracle::ExactHit>> hits);

  const scenes::Scene& scene() const { return *scene_; }
  const rays::TraceInput& input() const { return input_; }
  std::span<const std::optional<accel::oracle::ExactHit>> hits() const { return hits_; }
  /// Returns the number of rays that hit.
  std::uint64_t hit_count() const;
  /// Returns the hits of an image, with `t` rounded to float.
  accel::HitBuffer rounded() const;

 private:
  const scenes::Scene* scene_;
  rays::TraceInput input_;
  std::vector<std::optional<accel::oracle::ExactHit>> hits_;
};

/// Compares results with the oracle's hits, in parts if there are too many for memory at once.
/// Disputed rays are judged by exact arithmetic until 64 errors are found or the search has made
/// 4e8 primitive tests; later disputes count as structure errors without verification.
class Differ {
 public:
  /// Receives every ray whose class is not kAgree.
  using OnMismatch = std::function<void(const Mismatch&)>;

  /// Takes the structure's conformance. For kBaseline, only misses are correct; hits are structure
  /// errors.
  explicit Differ(accel::Conformance conformance, OnMismatch on_mismatch = {})
      : conformance_(conformance), on_mismatch_(std::move(on_mismatch)) {}

  /// Compares the next rays; all parts must be over one scene. Writes the class of each ray to
  /// `classes` unless that is empty. `faults`, unless empty, gives the reason for each ray whose
  /// result is already known to be wrong, and nothing for other rays. Throws std::logic_error if
  /// the results, classes or faults do not have the shape of the input.
  void compare(const ReferenceHits& reference, const rays::TraceResults& results,
               std::span<DiffClass> classes = {}, std::span<const std::string_view> faults = {});

  /// Returns the findings of all parts. Call it once.
  DiffReport finish();

 private:
  class Part;

  accel::Conformance conformance_;
  OnMismatch on_mismatch_;
  DiffReport report_;
  std::uint64_t search_tests_ = 0;
  bool may_graze_ = false;
};

/// Runs a `Differ` on one part.
DiffReport verify_results(const ReferenceHits& reference, const rays::TraceResults& results,
                          accel::Conformance conformance, std::span<DiffClass> classes = {});

}  // namespace beambench::verify

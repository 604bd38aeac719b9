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

/// The hit with `t` rounded to float.
inline std::optional<accel::Hit> rounded(const std::optional<accel::oracle::ExactHit>& hit) {
  if (!hit) return std::nullopt;
  return accel::Hit{static_cast<float>(hit->t), hit->primitive};
}

/// The oracle's closest hit of each ray, computed on all cores. The oracle must reach as far as the
/// input (`TraceInput::reach`).
std::vector<std::optional<accel::oracle::ExactHit>> oracle_hits(const accel::oracle::Oracle& oracle,
                                                                const rays::TraceInput& input);

/// The oracle's closest hit of each ray of an input, computed once (on all cores) and used for
/// every contender. The scene must outlive it.
class ReferenceHits {
 public:
  ReferenceHits(const scenes::Scene& scene, rays::TraceInput input);
  /// The same with hits from elsewhere.
  ReferenceHits(const scenes::Scene& scene, rays::TraceInput input,
                std::vector<std::optional<accel::oracle::ExactHit>> hits);

  const scenes::Scene& scene() const { return *scene_; }
  const rays::TraceInput& input() const { return input_; }
  std::span<const std::optional<accel::oracle::ExactHit>> hits() const { return hits_; }
  /// How many rays hit.
  std::uint64_t hit_count() const;
  /// The hits of an image, `t` rounded to float.
  accel::HitBuffer rounded() const;

 private:
  const scenes::Scene* scene_;
  rays::TraceInput input_;
  std::vector<std::optional<accel::oracle::ExactHit>> hits_;
};

/// Compares results with the oracle's hits, part by part where there are too many to be in memory
/// at once. Disputed rays are judged by exact arithmetic until 64 errors are found or the search
/// has made 4e8 primitive tests; what is disputed beyond that counts as structure error, unproven.
class Differ {
 public:
  /// Gets every ray whose class is not kAgree.
  using OnMismatch = std::function<void(const Mismatch&)>;

  /// For Conformance::kBaseline only misses are right; others are structure errors.
  explicit Differ(accel::Conformance conformance, OnMismatch on_mismatch = {})
      : conformance_(conformance), on_mismatch_(std::move(on_mismatch)) {}

  /// Compares the next rays; all parts are over one scene. `classes`, unless empty, gets that of
  /// each ray. `faults`, unless empty, has for each ray why its answer is wrong, as far as that is
  /// known before, or nothing. Throws std::logic_error when the results, classes or faults are not
  /// of the shape of the input.
  void compare(const ReferenceHits& reference, const rays::TraceResults& results,
               std::span<DiffClass> classes = {}, std::span<const std::string_view> faults = {});

  /// What was found in all parts. Call it once.
  DiffReport finish();

 private:
  class Part;

  accel::Conformance conformance_;
  OnMismatch on_mismatch_;
  DiffReport report_;
  std::uint64_t search_tests_ = 0;
};

/// A `Differ` of one part.
DiffReport verify_results(const ReferenceHits& reference, const rays::TraceResults& results,
                          accel::Conformance conformance, std::span<DiffClass> classes = {});

}  // namespace beambench::verify

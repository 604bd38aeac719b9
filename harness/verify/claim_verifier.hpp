#pragma once
// Verifies hits reported by any program, in parts, with a constant amount of memory.

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "accel/core/ray.hpp"
#include "harness/rays/claimed_hits.hpp"
#include "harness/rays/ray_set.hpp"
#include "harness/verify/diff_report.hpp"
#include "scenes/base/error.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// Thrown for a number that is impossible for a hit or ray. `what()` describes the fault without
/// its place.
class InvalidClaim : public InputError {
 public:
  InvalidClaim(std::size_t index, const std::string& fault) : InputError(fault), index(index) {}

  std::size_t index;  ///< of the ray, counted over all parts
};

/// The differ for hits from other programs. Each ray gets one of the classes of `DiffClass`;
/// `kStructureError` means that the program is wrong. t and points are compared as floats; a point
/// must lie within K u of the ray. If no primitive is given, it is the one on which the point lies,
/// or the oracle's if it lies on several.
///
///     verify::ClaimVerifier verifier(scene);
///     verifier.add(rays, {.t = t, .primitives = ids});
///     const verify::DiffReport report = verifier.finish();
///     if (report.verdict != verify::Verdict::kOk) ...
class ClaimVerifier {
 public:
  /// Receives every ray whose class is not kAgree.
  using OnMismatch = std::function<void(const Mismatch&)>;

  /// The scene must outlive this object.
  explicit ClaimVerifier(const scenes::Scene& scene, OnMismatch on_mismatch = {});
  ~ClaimVerifier();
  ClaimVerifier(ClaimVerifier&&) noexcept;
  ClaimVerifier& operator=(ClaimVerifier&&) = delete;

  /// Applies the `may_graze` and `must_hit` of a ray file.
  void judge_as(const rays::RaySet& rays);

  /// Verifies the next rays, all parts in the same form, on all cores. Writes the class of each ray
  /// to `classes` unless that is empty. Throws InvalidClaim for an invalid ray (`require_valid`),
  /// NaN in t or a point, an id that is not in the scene, a primitive at an infinite place, and
  /// values of `occluded` other than 0 and 1; nothing of this part is then counted. Throws
  /// std::logic_error if `ClaimedHits::size` does, and if the numbers of rays, hits and classes
  /// differ.
  void add(std::span<const accel::Ray> rays, const rays::ClaimedHits& hits,
           std::span<DiffClass> classes = {});

  /// Returns the findings of all parts. Call it once.
  DiffReport finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace beambench::verify

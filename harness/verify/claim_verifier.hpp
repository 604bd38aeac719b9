#pragma once
// Verifies hits that any program reports, part by part, in memory that does not grow with them.

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "accel/core/ray.hpp"
#include "harness/rays/claimed_hits.hpp"
#include "harness/verify/diff_report.hpp"
#include "scenes/base/error.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// A number that no hit or ray can have. `what()` is the fault without its place.
class InvalidClaim : public InputError {
 public:
  InvalidClaim(std::size_t index, const std::string& fault) : InputError(fault), index(index) {}

  std::size_t index;  ///< of the ray, counted over all parts
};

/// The differ for hits from outside. Each ray gets one of the classes of `DiffClass`, of which
/// `kStructureError` means that the program is wrong. t and points are compared as floats; a point
/// must lie within K u of the ray. Where no primitive is named, it is the one that the point lies
/// on, the oracle's where it lies on several.
///
///     verify::ClaimVerifier verifier(scene);
///     verifier.add(rays, {.t = t, .primitives = ids});
///     const verify::DiffReport report = verifier.finish();
///     if (report.verdict != verify::Verdict::kOk) ...
class ClaimVerifier {
 public:
  /// Gets every ray whose class is not kAgree.
  using OnMismatch = std::function<void(const Mismatch&)>;

  /// The scene must outlive it.
  explicit ClaimVerifier(const scenes::Scene& scene, OnMismatch on_mismatch = {});
  ~ClaimVerifier();
  ClaimVerifier(ClaimVerifier&&) noexcept;
  ClaimVerifier& operator=(ClaimVerifier&&) = delete;

  /// Verifies the next rays, all parts in the same form, on all cores. `classes`, unless empty,
  /// gets that of each. Throws InvalidClaim for a ray that `require_valid` refuses, NaN in t or a
  /// point, an id that the scene does not have, a primitive without t or point and the other way
  /// round, and `occluded` other than 0 and 1; nothing of the part counts then. Throws
  /// std::logic_error as `ClaimedHits::size`, and where there are not as many rays, hits and
  /// classes.
  void add(std::span<const accel::Ray> rays, const rays::ClaimedHits& hits,
           std::span<DiffClass> classes = {});

  /// What was found in all parts. Call it once.
  DiffReport finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace beambench::verify

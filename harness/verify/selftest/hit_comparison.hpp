#pragma once
// The correct hits over a scene, according to the structure's claim: bit for bit those of
// exhaustive search, or correct by the differ's classes.

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "accel/core/accelerator.hpp"
#include "accel/core/registry.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/verify/diff_report.hpp"
#include "harness/verify/minimize.hpp"

namespace beambench::verify {

/// A fault in a structure's hits.
struct WrongHits {
  std::string what;        ///< a sentence
  rays::TraceInput input;  ///< the input with the fault
  Mismatch first;          ///< of a ray of `input`
};

/// Compares a structure's hits with the correct hits. Each method returns the fault, or nothing if
/// all are correct. The scene must outlive this object.
class HitComparison {
 public:
  HitComparison(const scenes::Scene& scene, accel::Conformance conformance)
      : scene_(&scene), exhaustive_(scene), conformance_(conformance) {}

  /// Compares closest and any hits of single rays. If every bit must be equal, each ray is also
  /// traced once so that it ends and once so that it begins exactly at its hit. `must_hit`: the
  /// rays are inside a closed surface, and at most 1% of them may leak; the kit allows no leaks.
  std::optional<WrongHits> single_rays(const accel::Accelerator& structure,
                                       std::span<const accel::Ray> rays,
                                       bool must_hit = false) const;

  /// Compares the hits of an image or of a list with its pencils, traced as a whole. `may_graze`:
  /// more grazes than the differ's budget are allowed, for example because the camera may lie on a
  /// surface.
  std::optional<WrongHits> whole(const accel::Accelerator& structure, const rays::TraceInput& input,
                                 bool may_graze) const;

  std::size_t count_hits(std::span<const accel::Ray> rays) const;

 private:
  std::optional<WrongHits> same_bits(const accel::Accelerator& structure,
                                     const accel::Ray& ray) const;
  std::optional<WrongHits> same_bits(const accel::Accelerator& structure,
                                     const rays::TraceInput& input) const;
  std::optional<WrongHits> right_by_differ(const accel::Accelerator& structure,
                                           const rays::TraceInput& input, bool may_graze) const;

  const scenes::Scene* scene_;
  accel::exhaustive::Exhaustive exhaustive_;
  accel::Conformance conformance_;
};

/// Returns a function for `minimize`, which runs a structure again over parts of a scene and
/// compares its hits in the same way.
FindWrong wrong_by_comparison(const accel::StructureChoice& structure);

}  // namespace beambench::verify

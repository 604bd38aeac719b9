#pragma once
// The right hits over a scene, by what a structure claims: every bit those of exhaustive search, or
// right by the differ's classes.

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

/// What is wrong with a structure's hits.
struct WrongHits {
  std::string what;        ///< a sentence
  rays::TraceInput input;  ///< that got them
  Mismatch first;          ///< of a ray of `input`
};

/// Compares hits with the right ones. Each method returns what is wrong, and nothing when all are
/// right. The scene outlives it.
class HitComparison {
 public:
  HitComparison(const scenes::Scene& scene, accel::Conformance conformance)
      : scene_(&scene), exhaustive_(scene), conformance_(conformance) {}

  /// Closest and any hits of single rays. Where every bit must be equal, each ray is also traced
  /// with its end, and with its beginning, exactly where it hits.
  std::optional<WrongHits> single_rays(const accel::Accelerator& structure,
                                       std::span<const accel::Ray> rays) const;

  /// The hits of an image or of a list with its pencils, traced as a whole. `may_graze`: more
  /// grazes than the differ's budget are right, as they are where the camera lies on a surface.
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

/// Asks a structure again over parts of a scene, by `HitComparison::whole`: for `minimize`.
FindWrong wrong_by_comparison(const accel::StructureChoice& structure);

}  // namespace beambench::verify

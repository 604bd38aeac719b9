#pragma once
// The differ: judges a structure's hits against the oracle, ray by ray.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "accel/core/registry.hpp"
#include "accel/embree/oracle.hpp"
#include "harness/rays/trace_input.hpp"
#include "harness/rays/trace_results.hpp"
#include "scenes/scene.hpp"

namespace beambench::verify {

/// How one answer compares. u is 2^-24 x (largest |coordinate| + distance of the ray's origin), K
/// is 16: right hits of Embree in float were found up to 3.6 u off. The first three need a
/// sound answer: its point lies within K u of the primitive it names. An answer to an any-hit query
/// names no place, so it never ties: it agrees, or it grazes where every hit that is in dispute
/// does.
enum class DiffClass : std::size_t {
  kAgree,        ///< same primitive, |dt| x |cos theta| <= K u (a sphere or cone: the point is
                 ///< within K u of the surface, where the ray enters or leaves as the oracle's)
  kTie,          ///< other primitive at the same place: |dt| x the smaller |cos theta| <= K u
  kGraze,        ///< the disputed primitive's boundary is within K u of the ray, or the disputed
                 ///< hit within K u of the ray's end
  kEngineError,  ///< the structure is wrong, by long-double search over all primitives
  kEmbreeError,  ///< the structure is right and the oracle wrong, by the same search
  kCount
};
inline constexpr std::array<std::string_view, static_cast<std::size_t>(DiffClass::kCount)>
    kDiffClassNames{"agree", "tie", "graze", "engine_error", "embree_error"};

/// The sentence over all answers.
enum class Verdict {
  kOk,        ///< no engine error, grazes within the budget
  kMismatch,  ///< at least one engine error
  kGrazes,    ///< no engine error, but more grazes than max(2, 1e-4 x rays)
  kBaseline   ///< a structure that answers nothing by design, and did
};
std::string_view to_string(Verdict verdict);  // "ok", "mismatch", "grazes", "baseline"
/// What a record states in place of a verdict where the scene has no rays of the kind that was
/// asked for: nothing was judged, and nothing is wrong.
inline constexpr std::string_view kNoRays = "no_rays";
inline bool is_right(Verdict verdict) {
  return verdict == Verdict::kOk || verdict == Verdict::kBaseline;
}

/// One ray that did not agree, with all that is needed to look at it.
struct Mismatch {
  std::size_t index;  ///< of the ray
  accel::Ray ray;
  rays::Query query;
  DiffClass diff_class;
  std::optional<accel::Hit> engine;  ///< of a closest-hit query
  std::uint8_t engine_any_hit;       ///< of an any-hit query: 0, 1, or what the structure wrote
  std::optional<accel::embree::ExactHit> oracle;  ///< the closest hit, whatever the query
  /// The long-double answer; absent where the class was settled without it, or for an exact miss.
  std::optional<accel::embree::ExactHit> exact;
  bool adjudicated;         ///< was the long-double search asked?
  std::string_view reason;  ///< why it was classed so: a clause for `describe`
};

/// What was found in one buffer.
struct DiffReport {
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;  ///< of the oracle
  std::array<std::uint64_t, static_cast<std::size_t>(DiffClass::kCount)> counts{};
  std::vector<Mismatch> examples;  ///< errors first, at most kMaxExamples of each class but agree
  Verdict verdict = Verdict::kOk;

  static constexpr std::size_t kMaxExamples = 10;
  std::uint64_t count(DiffClass diff_class) const {
    return counts[static_cast<std::size_t>(diff_class)];
  }
};

/// The oracle's closest hit of each ray of an input, computed once (on all cores) and used for
/// every contender. The scene must outlive it.
class ReferenceHits {
 public:
  ReferenceHits(const scenes::Scene& scene, rays::TraceInput input);
  /// The same with hits from elsewhere.
  ReferenceHits(const scenes::Scene& scene, rays::TraceInput input,
                std::vector<std::optional<accel::embree::ExactHit>> hits);

  const scenes::Scene& scene() const { return *scene_; }
  const rays::TraceInput& input() const { return input_; }
  std::span<const std::optional<accel::embree::ExactHit>> hits() const { return hits_; }
  /// How many rays hit.
  std::uint64_t hit_count() const;

 private:
  const scenes::Scene* scene_;
  rays::TraceInput input_;
  std::vector<std::optional<accel::embree::ExactHit>> hits_;
};

/// Judges a structure's answers. Disputed rays are searched in long double until their number is
/// hopeless (64 errors are proven, or the search has made 4e8 primitive tests); what is disputed
/// beyond that counts as engine error, unproven. For Conformance::kBaseline the only question is
/// whether all answers are misses; others are engine errors. `classes`, unless empty, gets that of
/// each ray. Throws std::logic_error when the results have not the shape that the input asks
/// for.
DiffReport judge(const ReferenceHits& reference, const rays::TraceResults& results,
                 accel::Conformance conformance, std::span<DiffClass> classes = {});

}  // namespace beambench::verify

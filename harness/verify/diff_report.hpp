#pragma once
// The findings of a verification: the classes of rays, the verdict, and the rays that did not
// agree.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "accel/core/ray.hpp"
#include "accel/oracle/oracle.hpp"
#include "harness/rays/ray_kind.hpp"

namespace beambench::verify {

/// The outcome of a comparison of one hit with the exact one. u is 2^-24 x (largest |coordinate| of
/// the hit + distance of the ray's origin from that of the coordinates), K is 16: correct hits of
/// Embree in float were found up to 3.6 u off. The first three classes require a valid result: its
/// point lies within K u of its primitive. Hits that differ from the oracle's are judged by exact
/// arithmetic (`classify_by_search`). A result of an any-hit query has no point, so it never ties:
/// it agrees, or it grazes if every disputed hit grazes.
enum class DiffClass : std::size_t {
  kAgree,  ///< the exact hit: same primitive, |dt| x |cos theta| <= K u (a sphere or cone:
           ///< the point is within K u of the surface, on the same side of it)
  kTie,    ///< other primitive at the same point: |dt| x |cos theta| of the nearer surface
           ///< <= K u, and |dt| <= 1024 K u
  kGraze,  ///< the ray passes the disputed primitive's boundary within K u, or begins or ends
           ///< at one place with its hit; hits behind such a hit are judged alike
  kStructureError,  ///< the structure is wrong, by exact arithmetic
  kOracleError,     ///< the oracle is wrong and the structure correct, by exact arithmetic
  kCount
};
inline constexpr std::array<std::string_view, static_cast<std::size_t>(DiffClass::kCount)>
    kDiffClassNames{"agree", "tie", "graze", "structure_error", "oracle_error"};
/// The names in records and JSON, which do not change.
inline constexpr std::array<std::string_view, kDiffClassNames.size()> kRecordedClassNames{
    "agree", "tie", "graze", "structure_error", "embree_error"};

/// The result of a verification, as stated in records.
enum class Verdict {
  kOk,          ///< no structure error, no leak, grazes within the budget
  kMismatch,    ///< at least one structure error or leak
  kGrazes,      ///< neither, but more than max(2, 1e-4 x rays) grazes without `RaySet::may_graze`
  kBaseline,    ///< a structure that returns no hits by design, and returned none
  kError,       ///< the structure could not be built or failed: nothing was verified
  kNoRays,      ///< the scene has no rays of the kind: nothing was verified, but nothing is wrong
  kUnsupported  ///< the structure does not support these rays or primitives: not a fault either
};
/// Returns "ok", "mismatch", "grazes", "baseline", "error", "no_rays", "unsupported".
std::string_view to_string(Verdict verdict);
inline bool is_right(Verdict verdict) {
  return verdict == Verdict::kOk || verdict == Verdict::kBaseline;
}

/// One ray that did not agree, with all data for examining it.
struct Mismatch {
  std::size_t index;  ///< of the ray, counted over all parts
  accel::Ray ray;
  rays::Query query;
  DiffClass diff_class;
  std::optional<accel::Hit> answer;  ///< the structure's result of a closest-hit query
  std::uint8_t any_hit_answer;       ///< the result of an any-hit query: 0, 1, or another number
  std::optional<accel::oracle::ExactHit> oracle;  ///< the closest hit, whatever the query
  std::optional<accel::oracle::ExactHit> exact;   ///< the exact hit, if it was searched
  bool searched;                                  ///< whether exact arithmetic judged the result
  std::string_view reason;  ///< the reason for its class: a clause for `describe`
  bool must_hit = false;    ///< see `rays::RaySet`
  bool leaked = false;      ///< a graze that is a miss, although the ray must hit

  /// Returns whether the structure reports that the ray hits nothing.
  bool is_miss() const { return query == rays::Query::kClosestHit ? !answer : any_hit_answer == 0; }
  /// Returns whether the structure is wrong.
  bool is_fault() const { return diff_class == DiffClass::kStructureError || leaked; }
};

/// The findings of a verification.
struct DiffReport {
  std::uint64_t rays = 0;
  std::uint64_t hits = 0;  ///< number of the oracle's hits
  std::array<std::uint64_t, static_cast<std::size_t>(DiffClass::kCount)> counts{};
  std::uint64_t leaks = 0;  ///< grazes that are misses of rays that must hit: faults
  std::vector<Mismatch>
      examples;  ///< errors first, at most kMaxExamples of each class except agree
  Verdict verdict = Verdict::kOk;

  static constexpr std::size_t kMaxExamples = 10;
  std::uint64_t count(DiffClass diff_class) const {
    return counts[static_cast<std::size_t>(diff_class)];
  }
  /// Returns the number of rays for which the structure is wrong.
  std::uint64_t faults() const { return count(DiffClass::kStructureError) + leaks; }
};

}  // namespace beambench::verify

// The judge against exact arithmetic: it accepts no claim that is off by more than 4 K u, and
// refuses no claim within K u / 4.
//
// Environment variables: BEAMBENCH_EXACT_CLAIMS=1000000 requests a million claims, which take a
// minute; BEAMBENCH_EXACT_SEED=N selects other claims; BEAMBENCH_EXACT_REPORT=N prints N violations
// of each family instead of 3.

#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "accel/core/ray.hpp"
#include "harness/verify/differ.hpp"
#include "tests/number_from.hpp"
#include "tests/verify/exact/acceptance.hpp"
#include "tests/verify/exact/claim_rays.hpp"
#include "tests/verify/exact/claim_scenes.hpp"
#include "tests/verify/exact/claim_text.hpp"
#include "tests/verify/exact/claims.hpp"

namespace beambench::exact {
namespace {

using verify::DiffClass;

struct Family {
  const char* name;
  scenes::Scene (*scene)(Random&);
  RayStyle style;
};

void PrintTo(const Family& family, std::ostream* stream) { *stream << family.name; }

using Start = RayStyle::Start;
using Limits = RayStyle::Limits;

const Family kFamilies[] = {
    {"HugeFloor", huge_floor, {}},
    {"HugeFloorFromAround", huge_floor, {.start = Start::kAround, .limits = Limits::kNone}},
    {"Stack", stack, {}},
    {"StackFromAround", stack, {.start = Start::kAround, .limits = Limits::kNone}},
    {"RaysInPlanes", planes, {.start = Start::kInPlane}},
    {"OriginsOnSurfaces", room, {.start = Start::kOnSurface}},
    {"LightsOnSurfaces", room, {.start = Start::kOnSurface, .limits = Limits::kSegment}},
    {"SharedEdges", sheet, {}},
    {"IntervalsEndingAtHits", room, {.limits = Limits::kOwnT}},
    {"AllExponents", room, {.all_exponents = true}},
    {"AllExponentsOverAHugeFloor", huge_floor, {.all_exponents = true}},
    {"AllSizes", room, {.all_sizes = true}},
    {"GeneralPosition", general, {}},
};

/// A result claimed for one ray, a closest hit or an occlusion, and whether it is correct.
struct Claim {
  accel::Ray ray;
  rays::Query query;
  ClosestClaim closest;
  bool occluded;
  bool right;
};

/// The claims about one scene, and the number of those that are neither clearly correct nor clearly
/// wrong.
struct Claims {
  std::vector<Claim> decided;
  std::size_t undecided = 0;
};

void decide(const Traced& traced, Claim claim, Claims& claims) {
  const auto accepts = [&](Leniency leniency) {
    const Acceptance acceptance(traced, leniency);
    return claim.query == rays::Query::kAnyHit ? acceptance.accepts_occlusion(claim.occluded)
                                               : acceptance.accepts(claim.closest);
  };
  const bool generous = accepts(kGenerous);
  claim.right = accepts(kStrict);
  ASSERT_TRUE(generous || !claim.right) << "acceptable at K u / 4, but not at 4 K u";
  if (generous == claim.right) {
    claims.decided.push_back(std::move(claim));
  } else {
    ++claims.undecided;
  }
}

/// Rays over a scene.
struct Problem {
  scenes::Scene scene;
  std::vector<accel::Ray> rays;
};

Problem make_problem(const Family& family, Random& random) {
  Problem problem{family.scene(random), {}};
  const std::vector<Solid> solids = solids_of(problem.scene);
  for (int i = 0; i < 10; ++i) {
    problem.rays.push_back(claim_ray(problem.scene, solids, family.style, random));
  }
  if (family.style.all_sizes) {
    const int power = -26 + static_cast<int>(random.below(53));  // extents from 1e-7 to 4e8
    problem.scene = times_two_to(power, std::move(problem.scene));
    for (accel::Ray& ray : problem.rays) {
      ray.origin *= std::ldexp(1.0F, power);
      ray.t_min = std::ldexp(ray.t_min, power);
      ray.t_max = std::ldexp(ray.t_max, power);
    }
  }
  return problem;
}

Claims make_claims(const std::vector<Solid>& solids, const std::vector<accel::Ray>& all_rays,
                   Random& random) {
  Claims claims;
  for (const accel::Ray& ray : all_rays) {
    const Traced traced(solids, ray);
    for (const ClosestClaim& claim : ClaimMaker(traced, random).closest()) {
      decide(traced, {ray, rays::Query::kClosestHit, claim, false, false}, claims);
    }
    for (const bool occluded : {false, true}) {
      decide(traced, {ray, rays::Query::kAnyHit, {}, occluded, false}, claims);
    }
  }
  return claims;
}

/// Returns the judge's classes for claims about one kind of query.
std::vector<DiffClass> judged(const scenes::Scene& scene, const std::vector<const Claim*>& claims) {
  rays::RaySet set;
  set.query = claims.front()->query;
  accel::HitBuffer hits(static_cast<int>(claims.size()), 1, 1);
  rays::AnyHits occluded(claims.size());
  for (std::size_t i = 0; i < claims.size(); ++i) {
    set.rays.push_back(claims[i]->ray);
    hits.set(i, claims[i]->closest);
    occluded[i] = claims[i]->occluded ? 1 : 0;
  }
  const bool any = set.query == rays::Query::kAnyHit;
  const verify::ReferenceHits reference(scene, rays::TraceInput(std::move(set)));
  std::vector<DiffClass> classes(claims.size());
  verify::verify_results(reference, any ? rays::TraceResults(occluded) : rays::TraceResults(hits),
                         accel::Conformance::kTolerance, classes);
  return classes;
}

/// Compares the judge with exact arithmetic, and counts the claims.
class Comparison {
 public:
  explicit Comparison(const Family& family) : family_(family) {}

  void add(std::uint64_t seed) {
    Random random(seed);
    const auto [scene, all_rays] = make_problem(family_, random);
    const std::vector<Solid> solids = solids_of(scene);
    const Claims claims = make_claims(solids, all_rays, random);
    undecided_ += claims.undecided;
    // The judge counts disputes as errors after the 64th one, so correct claims are kept separate
    // and wrong ones come in small parts.
    constexpr std::size_t kPart = 48;
    for (const rays::Query query : {rays::Query::kClosestHit, rays::Query::kAnyHit}) {
      for (const bool right : {true, false}) {
        std::vector<const Claim*> part;
        for (const Claim& claim : claims.decided) {
          if (claim.query != query || claim.right != right) continue;
          part.push_back(&claim);
          if (part.size() == kPart) compare_part(scene, solids, std::exchange(part, {}), seed);
        }
        if (!part.empty()) compare_part(scene, solids, part, seed);
      }
    }
  }

  std::size_t made() const { return right_ + wrong_ + undecided_; }
  std::size_t right() const { return right_; }
  std::size_t wrong() const { return wrong_; }
  std::size_t undecided() const { return undecided_; }
  std::size_t violations() const { return refused_ + accepted_; }
  std::string summary() const {
    return fmt::format(
        "{}: {} right claims, {} refused; {} wrong claims, {} accepted; {} undecided\n{}",
        family_.name, right_, refused_, wrong_, accepted_, undecided_, examples_);
  }

 private:
  void compare_part(const scenes::Scene& scene, const std::vector<Solid>& solids,
                    const std::vector<const Claim*>& part, std::uint64_t seed) {
    const std::vector<DiffClass> classes = judged(scene, part);
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Claim& claim = *part[i];
      ++(claim.right ? right_ : wrong_);
      if ((classes[i] != DiffClass::kStructureError) == claim.right) continue;
      std::size_t& count = claim.right ? refused_ : accepted_;
      static const std::uint64_t kReported = tests::number_from("BEAMBENCH_EXACT_REPORT", 3);
      if (count++ < kReported) {
        examples_ += fmt::format("seed {}: the judge {} this claim, which is {} (class {})\n{}",
                                 seed, claim.right ? "refuses" : "accepts",
                                 claim.right ? "within K u / 4" : "wrong by more than 4 K u",
                                 verify::kDiffClassNames[static_cast<std::size_t>(classes[i])],
                                 claim.query == rays::Query::kAnyHit
                                     ? text_of(scene, Traced(solids, claim.ray), claim.occluded)
                                     : text_of(scene, Traced(solids, claim.ray), claim.closest));
      }
    }
  }

  const Family& family_;
  std::size_t right_ = 0, wrong_ = 0, undecided_ = 0, refused_ = 0, accepted_ = 0;
  std::string examples_;
};

class ExactClaims : public ::testing::TestWithParam<Family> {};

TEST_P(ExactClaims, JudgeAcceptsCorrectClaimsAndRefusesWrongOnes) {
  const std::uint64_t wanted =
      tests::number_from("BEAMBENCH_EXACT_CLAIMS", 26'000) / std::size(kFamilies);
  const std::uint64_t first = tests::number_from("BEAMBENCH_EXACT_SEED", 1) * 10'000'000;
  Comparison comparison(GetParam());
  for (std::uint64_t seed = first; comparison.made() < wanted; ++seed) {
    comparison.add(seed);
    ASSERT_FALSE(HasFatalFailure()) << "seed " << seed;
  }
  EXPECT_EQ(comparison.violations(), 0U) << comparison.summary();
  EXPECT_GT(comparison.right(), comparison.made() / 20) << comparison.summary();
  EXPECT_GT(comparison.wrong(), comparison.made() / 5) << comparison.summary();
  EXPECT_LT(comparison.undecided(), comparison.made() / 4) << comparison.summary();
  RecordProperty("claims", comparison.summary());
}

INSTANTIATE_TEST_SUITE_P(Families, ExactClaims, ::testing::ValuesIn(kFamilies),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace beambench::exact

// The self-test can fail: each of its checks detects a fault.

#include "harness/verify/selftest/selftest.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "accel/core/registry.hpp"
#include "accel/exhaustive/exhaustive.hpp"
#include "harness/verify/contact.hpp"
#include "harness/verify/minimize.hpp"
#include "harness/verify/selftest/hit_comparison.hpp"
#include "harness/verify/selftest/test_scenes.hpp"
#include "harness/verify/tolerance.hpp"
#include "scenes/base/error.hpp"
#include "scenes/base/parameters.hpp"

namespace beambench::verify {
namespace {

enum class Fault {
  kNone,
  kHighestIdAtTies,
  kNoCones,
  kMissesAtTheEnd,
  kImageUpsideDown,
  kAnyHitAlways,
  kOtherInLists,
  kOtherWhenCounting,
  kOtherInEveryBuild,
  kOneRayAtATime,
  kCountsNoTests,
  kMoreLeavesThanNodes,
  kExplainsAnother,
  kThrows,
  kRefusesAll,
  kLeaks,
};

std::atomic<int> builds = 0;
std::atomic<int> at_once = 0;

/// Exhaustive search with a fault.
class Faulty : public accel::TraversalAccelerator<Faulty> {
 public:
  Faulty(const scenes::Scene& scene, Fault fault)
      : scene_(&scene), fault_(fault), number_(builds++) {}

  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override {
    TraversalAccelerator::closest_hits(rays, hits, context);
    if (rays.image() != nullptr && fault_ == Fault::kImageUpsideDown) {
      std::reverse(hits.t(), hits.t() + hits.size());
    }
    if (rays.batch() != nullptr && fault_ == Fault::kOtherInLists) {
      hits.t()[hits.size() - 1] = 1.0F;  // also of a miss
    }
  }

  template <class Counting>
  std::optional<accel::Hit> find_closest(const accel::Ray& ray, Counting& counting) const {
    constexpr bool kCounts = std::is_same_v<Counting, accel::WorkCounters>;
    constexpr bool kExplains = std::is_same_v<Counting, accel::StepRecorder>;
    if (fault_ == Fault::kThrows) throw std::runtime_error("no way");
    const bool alone = at_once++ == 0;
    counting.add(accel::Counter::kTraversalSteps);
    accel::ClosestHit closest(ray);
    for (scenes::PrimitiveId id = 0; id < scene_->primitives.size(); ++id) {
      if (fault_ == Fault::kNoCones && scene_->primitives[id].kind == scenes::PrimitiveKind::kCone)
        continue;
      if (fault_ == Fault::kExplainsAnother && kExplains && id % 2 == 0) continue;
      if (fault_ != Fault::kCountsNoTests) counting.add(accel::Counter::kPrimitiveTests);
      const accel::ClosestHit before = closest;
      const float t = closest.test(*scene_, id);
      if (fault_ == Fault::kLeaks && t == t && passes_edge(ray, {t, id})) closest = before;
      counting.tested(id, t);
      if (fault_ == Fault::kHighestIdAtTies && t == closest.ray.t_max) closest.primitive = id;
    }
    --at_once;
    std::optional<accel::Hit> hit = closest.result();
    const bool loses = (fault_ == Fault::kMissesAtTheEnd && hit && hit->t == ray.t_max) ||
                       (fault_ == Fault::kOtherWhenCounting && kCounts) ||
                       (fault_ == Fault::kOtherInEveryBuild && number_ % 2 == 0) ||
                       (fault_ == Fault::kOneRayAtATime && !alone);
    return loses ? std::nullopt : hit;
  }
  template <class Counting>
  bool find_any(const accel::Ray& ray, Counting& counting) const {
    return fault_ == Fault::kAnyHitAlways || find_closest(ray, counting).has_value();
  }
  accel::Statistics statistics() const override {
    accel::Statistics statistics;
    if (fault_ == Fault::kMoreLeavesThanNodes) statistics.leaves = 1;
    return statistics;
  }

 private:
  bool passes_edge(const accel::Ray& ray, const accel::Hit& hit) const {
    return scene_->primitives[hit.primitive].kind == scenes::PrimitiveKind::kPolygon &&
           boundary_distance(*scene_, ray, hit.primitive) <= tolerance(ray, hit.t);
  }

  const scenes::Scene* scene_;
  Fault fault_;
  int number_;
};

accel::StructureInfo faulty(Fault fault) {
  return {"faulty",
          "a fault",
          fault == Fault::kLeaks ? accel::Conformance::kTolerance : accel::Conformance::kBitExact,
          {},
          [fault](const scenes::Scene& scene, const Parameters&, const accel::Workload&) {
            if (fault == Fault::kRefusesAll) throw InputError("not this one");
            return std::make_unique<Faulty>(scene, fault);
          }};
}

Subject subject_of(const accel::StructureInfo& info) {
  return Subject(accel::StructureChoice(info, Parameters(info.name, info.parameters, {})));
}

/// Runs a check. `info` must outlive a failure.
CheckOutcome outcome_of(std::string_view name, const accel::StructureInfo& info) {
  const Subject subject = subject_of(info);
  for (const Check& check : selftest_checks()) {
    if (check.name == name) return run_check(check, subject, {.seed = 1, .scenes = 20});
  }
  ADD_FAILURE() << "there is no check " << name;
  return {};
}

std::string failure_of(std::string_view name, Fault fault) {
  const accel::StructureInfo info = faulty(fault);
  return outcome_of(name, info).failure;
}

TEST(Selftest, PassesCorrectStructures) {
  for (const Check& check : selftest_checks()) {
    EXPECT_EQ(failure_of(check.name, Fault::kNone), "") << check.name;
  }
}

// Embree's packets round differently from its single rays.
TEST(Selftest, ListsOfAStructureWithItsOwnArithmeticMayRoundDifferently) {
  const Subject subject(
      accel::registry().choose(parse_spec("embree:mode=stream,robust=false,coherent=true")));
  const auto lists = std::ranges::find(selftest_checks(), "lists", &Check::name);
  for (std::uint64_t seed = 290; seed < 300; ++seed) {
    EXPECT_EQ(run_check(*lists, subject, {.seed = seed}).failure, "") << seed;
  }
  accel::StructureInfo wrong = faulty(Fault::kOtherInLists);
  wrong.conformance = accel::Conformance::kTolerance;
  EXPECT_NE(outcome_of("lists", wrong).failure, "");
}

/// Exhaustive search that refuses most kinds of primitives.
accel::StructureInfo picky(PrimitiveKinds takes) {
  return {"picky",
          "not everything",
          accel::Conformance::kBitExact,
          {},
          [takes](const scenes::Scene& scene, const Parameters&, const accel::Workload&) {
            if (!takes.include(scene)) throw InputError("not this one");
            return std::make_unique<Faulty>(scene, Fault::kNone);
          }};
}

TEST(Selftest, TracesOnlySupportedPrimitives) {
  for (const PrimitiveKinds takes :
       {PrimitiveKinds{.cones = false}, PrimitiveKinds{false, true, false},
        PrimitiveKinds{true, false, false}, PrimitiveKinds{false, false, true}}) {
    const accel::StructureInfo info = picky(takes);
    const Subject subject = subject_of(info);
    EXPECT_EQ(subject.kinds().names(), takes.names());
    for (const Check& check : selftest_checks()) {
      if (!applies(check, subject)) {
        EXPECT_TRUE(check.of_polygons && !takes.polygons) << check.name;
        continue;
      }
      const CheckOutcome outcome = run_check(check, subject, {.seed = 1, .scenes = 40});
      EXPECT_EQ(outcome.failure, "") << check.name << " over " << takes.names().front();
      EXPECT_TRUE(outcome.rays > 0 || check.name == "statistics") << check.name;
    }
  }
}

/// Snapping makes one primitive in a hundred degenerate. If no primitive remained, positions would
/// not be numbers.
TEST(Selftest, RandomScenesAreNotEmptyAndTheirRaysAreNumbers) {
  for (std::uint64_t seed = 102'500; seed < 104'500; ++seed) {
    const scenes::Scene scene = random_scene(seed, 1);
    ASSERT_FALSE(scene.primitives.empty()) << seed;
    Random random(seed);
    for (const accel::Ray& ray : random_rays(scene, 20, random)) accel::require_valid(ray);
    accel::require_valid(accel::PrimaryRays(random_camera(scene, random), 1, 1, 1).ray(0, 0, 0));
  }
}

TEST(Selftest, DetectsAFaultInEachCheck) {
  const std::pair<const char*, Fault> expected[] = {
      {"random scenes", Fault::kNoCones},
      {"random scenes", Fault::kHighestIdAtTies},
      {"random scenes", Fault::kAnyHitAlways},
      {"random scenes", Fault::kRefusesAll},
      {"random scenes", Fault::kThrows},
      {"scene families", Fault::kNoCones},
      {"scene families", Fault::kHighestIdAtTies},
      {"scene families", Fault::kImageUpsideDown},
      {"views", Fault::kNoCones},
      {"views", Fault::kHighestIdAtTies},
      {"views", Fault::kImageUpsideDown},
      {"views", Fault::kAnyHitAlways},
      {"views", Fault::kOtherInLists},
      {"smallest scenes", Fault::kNoCones},
      {"images", Fault::kImageUpsideDown},
      {"faces, edges, corners", Fault::kHighestIdAtTies},
      {"closed meshes", Fault::kLeaks},
      {"degenerate rays", Fault::kMissesAtTheEnd},
      {"heap", Fault::kHighestIdAtTies},
      {"lists", Fault::kOtherInLists},
      {"counting", Fault::kOtherWhenCounting},
      {"two builds", Fault::kOtherInEveryBuild},
      {"threads", Fault::kOneRayAtATime},
      {"counters", Fault::kCountsNoTests},
      {"statistics", Fault::kMoreLeavesThanNodes},
      {"explanation", Fault::kExplainsAnother},
  };
  for (const auto& [check, fault] : expected) {
    EXPECT_NE(failure_of(check, fault), "") << check << ", fault " << static_cast<int>(fault);
  }
  for (const Check& check : selftest_checks()) {
    EXPECT_TRUE(
        std::ranges::any_of(expected, [&](const auto& one) { return check.name == one.first; }))
        << check.name << " has never been seen to fail";
  }
}

/// At an edge, a structure with its own arithmetic may miss, except in closed meshes.
TEST(Selftest, ALeakIsFoundInClosedMeshesAloneAndReducedToAFewTriangles) {
  for (const char* name : {"random scenes", "scene families", "views"}) {
    EXPECT_EQ(failure_of(name, Fault::kLeaks), "") << name;
  }
  const accel::StructureInfo info = faulty(Fault::kLeaks);
  const CheckOutcome outcome = outcome_of("closed meshes", info);
  EXPECT_NE(outcome.failure.find("leak, it left a closed surface"), std::string::npos)
      << outcome.failure;
  ASSERT_TRUE(outcome.failed.has_value());
  base::Progress progress(1);
  const auto minimal = minimize(outcome.failed->scene, outcome.failed->input, outcome.failed->wrong,
                                wrong_by_comparison(outcome.failed->structure), progress);
  ASSERT_TRUE(minimal.has_value());
  EXPECT_TRUE(minimal->mismatch.leaked);
  EXPECT_GE(minimal->scene.primitives.size(), 2U);
  EXPECT_LE(minimal->scene.primitives.size(), 8U);
  EXPECT_EQ(minimal->input.size(), 1U);
}

TEST(Selftest, WrongHitsAreReducedToTheNecessaryRayAndPrimitives) {
  const accel::StructureInfo info = faulty(Fault::kNoCones);
  for (const char* name : {"random scenes", "scene families", "views", "heap"}) {
    const CheckOutcome outcome = outcome_of(name, info);
    if (name == std::string("heap")) {  // has only spheres, so it passes
      EXPECT_FALSE(outcome.failed.has_value());
      continue;
    }
    ASSERT_TRUE(outcome.failed.has_value()) << name;
    base::Progress progress(1);
    const auto minimal =
        minimize(outcome.failed->scene, outcome.failed->input, outcome.failed->wrong,
                 wrong_by_comparison(outcome.failed->structure), progress);
    ASSERT_TRUE(minimal.has_value()) << name;
    EXPECT_EQ(minimal->scene.cones.size(), 1U) << name;
    // The cone that was lost, and the primitive hit behind it, if any.
    EXPECT_EQ(minimal->scene.primitives.size(), outcome.failed->wrong.answer ? 2U : 1U) << name;
    EXPECT_TRUE(minimal->input.size() == 1 || minimal->input.image() != nullptr) << name;
  }
}

TEST(Selftest, AFaultOfTheWholeImageIsReducedToItsPrimitives) {
  const accel::StructureInfo info = faulty(Fault::kImageUpsideDown);
  const CheckOutcome outcome = outcome_of("views", info);
  ASSERT_TRUE(outcome.failed.has_value());
  base::Progress progress(1);
  const auto minimal = minimize(outcome.failed->scene, outcome.failed->input, outcome.failed->wrong,
                                wrong_by_comparison(outcome.failed->structure), progress);
  ASSERT_TRUE(minimal.has_value());
  EXPECT_NE(minimal->input.image(), nullptr);
  EXPECT_EQ(minimal->scene.primitives.size(), 1U);
}

TEST(Selftest, TheNumberOfRaysIsConfigurable) {
  const accel::StructureInfo info = faulty(Fault::kNone);
  const Subject subject = subject_of(info);
  for (const Check& check : selftest_checks()) {
    const bool random =
        check.name == "random scenes" || check.name == "scene families" || check.name == "views";
    if (!random) continue;
    const auto few = run_check(check, subject, {.seed = 1, .scenes = 7, .rays = 100});
    const auto many = run_check(check, subject, {.seed = 1, .scenes = 7, .rays = 1000});
    EXPECT_GE(few.rays, 7U * 60U) << check.name;
    EXPECT_GE(many.rays, few.rays + 7U * 600U) << check.name;
  }
}

}  // namespace
}  // namespace beambench::verify

// Whole pictures as a task of sweeps: every ray after the camera rays is counted and verified.

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "accel/core/traversal_accelerator.hpp"
#include "harness/measure/task.hpp"
#include "harness/render/verified_picture.hpp"
#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"
#include "tests/drawn.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::render {
namespace {

/// Returns a group that requests a whole picture of a scene.
measure::CellGroup group_of(scenes::Scene scene, const std::string& rays = "whitted") {
  const scenes::Camera camera = scene.cameras.front();
  return {std::make_shared<const scenes::Scene>(std::move(scene)),
          7,  // arbitrary hash
          camera,
          {40, 30},
          1,
          rays::parse_ray_choice(rays),
          1,
          {}};
}

accel::StructureChoice choice(const std::string& spec) {
  return accel::registry().choose(parse_spec(spec));
}

/// Traces with a structure as a sweep does with a contender; returns the verification of the hits.
verify::DiffReport verified(measure::Task& task, const std::string& spec) {
  const auto structure = choice(spec).build(task.scene());
  task.poison();
  task.trace(*structure);
  const std::uint64_t timed = task.fingerprint();
  verify::DiffReport report = task.verify_results(*structure, choice(spec)).report;
  EXPECT_EQ(task.fingerprint(), timed) << "the verified results differ from the timed ones";
  return report;
}

std::uint64_t ray_count(const measure::CountedWork& work) {
  std::uint64_t rays = 0;
  for (const measure::RaysOfKind& kind : work.kinds) rays += kind.rays;
  return rays;
}

TEST(WholePicture, EveryStructureIsCorrectForEveryRay) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const measure::CellGroup group = group_of(scene_of_all_surfaces(seed));
    const auto task = measure::make_task(group, group.rays, -1, std::nullopt);
    std::uint64_t expected = 0;
    for (const char* spec : {"exhaustive", "samet", "samet-net", "voxel-grid", "goldsmith-salmon",
                             "sah-bvh", "beam", "tile-beam", "embree"}) {
      SCOPED_TRACE(spec);
      const verify::DiffReport report = verified(*task, spec);
      EXPECT_EQ(report.verdict, verify::Verdict::kOk);
      EXPECT_GT(report.rays, 1U * 40 * 30);
      if (choice(spec).info().conformance != accel::Conformance::kBitExact) continue;
      if (expected == 0) expected = task->fingerprint();
      EXPECT_EQ(task->fingerprint(), expected);
    }
    EXPECT_EQ(verified(*task, "null").verdict, verify::Verdict::kBaseline);
  }
}

TEST(WholePicture, CountsWorkByKindOfRays) {
  const measure::CellGroup group = group_of(scene_of_all_surfaces(2));  // with glass
  const auto task = measure::make_task(group, group.rays, -1, std::nullopt);
  const auto structure = choice("exhaustive").build(task->scene());
  task->trace(*structure);
  const std::uint64_t timed = task->fingerprint();
  const measure::CountedWork work = task->count(*structure);
  EXPECT_EQ(task->fingerprint(), timed);
  EXPECT_EQ(ray_count(work), task->facts().rays);
  const RayCensus census = picture(task->scene(), "exhaustive", {}).census;
  ASSERT_EQ(work.kinds.size(), 4U);
  EXPECT_EQ(work.kinds[0].rays, census.eye);
  EXPECT_EQ(work.kinds[1].rays, census.reflected);
  EXPECT_EQ(work.kinds[2].rays, census.refracted);
  EXPECT_EQ(work.kinds[3].rays, census.shadow);
  // Exhaustive search tests each of these rays against all primitives.
  const std::uint64_t primitives = task->scene().primitives.size();
  std::uint64_t tests = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint64_t of_kind = work.kinds[i].counters.at("primitive_tests");
    if (i < 3) {
      EXPECT_EQ(of_kind, primitives * work.kinds[i].rays);
    }
    tests += of_kind;
  }
  EXPECT_EQ(work.counters.at("primitive_tests"), tests);
}

TEST(WholePicture, ItsFactsMatchTheOraclesPicture) {
  const measure::CellGroup group = group_of(scenes::load_scene("balls:n=1"));
  const auto task = measure::make_task(group, group.rays, -1, std::nullopt);
  const measure::RaySetFacts& facts = task->facts();
  EXPECT_EQ(facts.scene_hash, 7U);
  EXPECT_EQ(facts.query, rays::Query::kPicture);
  const measure::HarnessShare share =
      task->harness_share(*choice("exhaustive").build(task->scene()));
  EXPECT_EQ(share.path, measure::QueryPath::kPicture);
  EXPECT_GT(share.ms, 0.0);
  EXPECT_GT(facts.hit_share.value(), 0.2);
  EXPECT_LT(facts.occluded_share.value(), 0.9);
  EXPECT_FALSE(facts.coherence);
  EXPECT_EQ(measure::make_task(group, group.rays, -1, std::nullopt)->facts().rays_hash,
            facts.rays_hash);
  const measure::CellGroup shallow = group_of(scenes::load_scene("balls:n=1"), "whitted:depth=1");
  EXPECT_NE(measure::make_task(shallow, shallow.rays, -1, std::nullopt)->facts().rays_hash,
            facts.rays_hash);
}

/// `exhaustive` with occasional errors, which it makes only when it traces single rays.
class WrongAlone : public accel::TraversalAccelerator<WrongAlone> {
 public:
  enum class In { kClosest, kAny };
  WrongAlone(const scenes::Scene& scene, In in) : right_(built(scene, "exhaustive")), in_(in) {}

  accel::Statistics statistics() const override { return {}; }
  void closest_hits(const accel::RaySource& rays, const accel::HitSpan& hits,
                    const accel::QueryContext& context) const override {
    if (rays.image() != nullptr) return right_->closest_hits(rays, hits, context);
    TraversalAccelerator::closest_hits(rays, hits, context);
  }
  template <class Counting>
  std::optional<accel::Hit> find_closest(const accel::Ray& ray, Counting&) const {
    const auto hit = right_->closest_hit(ray, nullptr);
    return in_ == In::kClosest && hit && hit->primitive % 7 == 0 ? std::nullopt : hit;
  }
  template <class Counting>
  bool find_any(const accel::Ray& ray, Counting&) const {
    return in_ == In::kAny ? false : right_->any_hit(ray, nullptr);
  }

 private:
  std::unique_ptr<accel::Accelerator> right_;
  In in_;
};

TEST(WholePicture, AWrongRayThatFollowsIsFoundAndNamed) {
  const measure::CellGroup group = group_of(scene_of_all_surfaces(1));  // without glass
  const auto task = measure::make_task(group, group.rays, -1, std::nullopt);
  for (const auto& [in, name] : {std::pair{WrongAlone::In::kClosest, "reflected rays, ray "},
                                 std::pair{WrongAlone::In::kAny, "shadow rays, ray "}}) {
    const WrongAlone structure(task->scene(), in);
    task->trace(structure);
    const measure::Verification found = task->verify_results(structure, choice("exhaustive"));
    EXPECT_EQ(found.report.verdict, verify::Verdict::kMismatch);
    EXPECT_GT(found.report.count(verify::DiffClass::kStructureError), 0U);
    ASSERT_FALSE(found.examples.empty());
    for (const std::string& example : found.examples) EXPECT_TRUE(scenes::says(example, {name}));
  }
}

TEST(WholePicture, IsNotAListOfRays) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=1");
  const rays::ImageOfRays image{scene.cameras.front(), {8, 8}, 1};
  EXPECT_THROW(rays::make_trace_input(scene, image, rays::parse_ray_choice("whitted")), InputError);
}

}  // namespace
}  // namespace beambench::render

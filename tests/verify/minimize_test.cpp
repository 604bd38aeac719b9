// Reduction of wrong results, and subsets of scenes.

#include "harness/verify/minimize.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "harness/rays/ray_file.hpp"
#include "harness/verify/contact.hpp"
#include "harness/verify/describe.hpp"
#include "harness/verify/outside_program.hpp"
#include "harness/verify/selftest/closed_mesh.hpp"
#include "harness/verify/tolerance.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/formats/nff/nff_writer.hpp"
#include "scenes/subset.hpp"
#include "tests/scenes/thrown_message.hpp"
#include "tests/temporary_folder.hpp"

namespace beambench::verify {
namespace {

Tracer exhaustive() { return tracer_of(accel::registry().choose(parse_spec("exhaustive"))); }

rays::TraceInput primary_rays(const scenes::Scene& scene) {
  return accel::PrimaryRays(scene.cameras.front(), 24, 20, 1);
}

rays::TraceInput as_list(const rays::TraceInput& input) {
  rays::RaySet set;
  for (std::size_t i = 0; i < input.size(); ++i) set.rays.push_back(input.ray(i));
  return rays::TraceInput(std::move(set));
}

/// Returns a structure that is correct except that it loses the hits for which `loses` is true.
template <class Loses>
Tracer losing(Loses loses) {
  return [loses](const scenes::Scene& scene, const rays::TraceInput& input) {
    rays::HitTable hits = exhaustive()(scene, input);
    for (std::size_t i = 0; i < hits.t.size(); ++i) {
      if (hits.primitives[i] == scenes::kNoPrimitive || !loses(scene, input, hits, i)) continue;
      hits.t[i] = accel::kInfinity;
      hits.primitives[i] = scenes::kNoPrimitive;
    }
    return hits;
  };
}

MinimalCase reduced(const scenes::Scene& scene, const rays::TraceInput& input,
                    const Tracer& tracer) {
  const DiffReport report = verify_tracer(scene, input, tracer);
  EXPECT_GT(report.faults(), 0U);
  base::Progress progress(1);
  auto found = minimize(scene, input, report.examples.front(), wrong_by_differ(tracer), progress);
  EXPECT_TRUE(found.has_value());
  return std::move(*found);
}

class Minimize : public ::testing::Test {
 protected:
  scenes::Scene scene_ = scenes::load_scene("tetra:n=3");
  rays::TraceInput list_ = as_list(primary_rays(scene_));
};

TEST_F(Minimize, OnePrimitiveAndOneRayRemain) {
  const MinimalCase found =
      reduced(scene_, list_, losing([](auto&, auto&, auto&, std::size_t) { return true; }));
  EXPECT_EQ(found.primitives.size(), 1U);
  EXPECT_EQ(found.scene.primitives.size(), 1U);
  EXPECT_EQ(found.input.size(), 1U);
  EXPECT_EQ(found.mismatch.diff_class, DiffClass::kStructureError);
}

TEST_F(Minimize, AsManyPrimitivesRemainAsTheFaultNeeds) {
  const MinimalCase found =
      reduced(scene_, list_, losing([](const scenes::Scene& scene, auto&, auto&, std::size_t) {
                return scene.primitives.size() >= 5;
              }));
  EXPECT_EQ(found.primitives.size(), 5U);
  EXPECT_TRUE(std::ranges::is_sorted(found.primitives));
  EXPECT_EQ(found.input.size(), 1U);
}

TEST_F(Minimize, AsManyRaysRemainAsTheFaultNeeds) {
  const MinimalCase found =
      reduced(scene_, list_, losing([](auto&, const rays::TraceInput& input, auto&, std::size_t) {
                return input.size() >= 3;
              }));
  EXPECT_EQ(found.input.size(), 3U);
  EXPECT_EQ(found.primitives.size(), 1U);
}

TEST_F(Minimize, AnImageStaysWholeIfTheFaultNeedsIt) {
  const MinimalCase found = reduced(scene_, primary_rays(scene_),
                                    losing([](auto&, const rays::TraceInput& input, auto&,
                                              std::size_t) { return input.image() != nullptr; }));
  EXPECT_EQ(found.input.size(), 480U);
  EXPECT_NE(found.input.image(), nullptr);
  EXPECT_EQ(found.primitives.size(), 1U);
  const TemporaryFolder folder;
  write_case(folder.path(), found, "tetra:n=3", "mine");
  const rays::RaySet set = rays::read_ray_file(folder.path() / "ray.rays");
  ASSERT_EQ(set.rays.size(), 1U);
  EXPECT_EQ(set.rays[0].direction, found.mismatch.ray.direction);
}

/// Over few primitives, the tracer loses every hit, which is not the fault to be reduced.
TEST_F(Minimize, TheFaultStaysTheSame) {
  const Tracer wrong = [](const scenes::Scene& scene, const rays::TraceInput& input) {
    rays::HitTable hits = exhaustive()(scene, input);
    for (std::size_t i = 0; i < hits.t.size(); ++i) {
      if (hits.primitives[i] == scenes::kNoPrimitive) continue;
      if (scene.primitives.size() >= 4) {
        hits.t[i] *= 0.5F;
      } else {
        hits.t[i] = accel::kInfinity;
        hits.primitives[i] = scenes::kNoPrimitive;
      }
    }
    return hits;
  };
  const MinimalCase found = reduced(scene_, list_, wrong);
  EXPECT_EQ(found.primitives.size(), 4U);
  EXPECT_EQ(found.mismatch.reason, "the ray does not meet that primitive at that t");
}

/// Returns a tracer that treats points near an edge as outside the triangle.
Tracer leaking() {
  return losing([](const scenes::Scene& scene, const rays::TraceInput& input,
                   const rays::HitTable& hits, std::size_t i) {
    const accel::Ray ray = input.ray(i);
    return boundary_distance(scene, ray, hits.primitives[i]) <= tolerance(ray, hits.t[i]);
  });
}

rays::TraceInput rays_at_edges_from_inside(const ClosedMesh& mesh) {
  Random random(3);
  rays::RaySet set;
  set.rays = rays_from_inside(mesh, 40, random);
  set.may_graze = true;
  set.must_hit = true;
  return rays::TraceInput(std::move(set));
}

TEST(Leaks, AreFaultsOfRaysThatMustHit) {
  const ClosedMesh mesh = closed_mesh({10.0, -3.0, 7.0}, 2.0);
  const rays::TraceInput input = rays_at_edges_from_inside(mesh);
  EXPECT_EQ(verify_tracer(mesh.scene, input, exhaustive()).faults(), 0U);
  const DiffReport report = verify_tracer(mesh.scene, input, leaking());
  EXPECT_EQ(report.verdict, Verdict::kMismatch);
  EXPECT_EQ(report.count(DiffClass::kStructureError), 0U);
  EXPECT_GT(report.leaks, 10U);
  EXPECT_TRUE(report.examples.front().leaked);
  EXPECT_TRUE(scenes::says(describe(mesh.scene, report.examples.front()),
                           {": leak, it left a closed surface"}));
  EXPECT_EQ(to_json(report.examples.front())["class"], "leak");

  rays::RaySet pardoned = *input.list();
  pardoned.must_hit = false;
  const DiffReport grazes =
      verify_tracer(mesh.scene, rays::TraceInput(std::move(pardoned)), leaking());
  EXPECT_EQ(grazes.verdict, Verdict::kOk);
  EXPECT_EQ(grazes.leaks, 0U);
}

/// A miss at the rim of a single triangle is correct, so a leak needs all triangles that meet where
/// the ray passes.
TEST(Leaks, AreReducedToThePrimitivesThatMeetThere) {
  const ClosedMesh mesh = closed_mesh({10.0, -3.0, 7.0}, 2.0);
  const rays::TraceInput input = rays_at_edges_from_inside(mesh);
  for (std::size_t i = 1; i < 5; ++i) {
    rays::RaySet one = *input.list();
    one.rays = {input.ray(i)};
    const rays::TraceInput ray(std::move(one));
    if (verify_tracer(mesh.scene, ray, leaking()).leaks == 0) continue;
    const MinimalCase found = reduced(mesh.scene, ray, leaking());
    EXPECT_GE(found.primitives.size(), 2U);
    EXPECT_LE(found.primitives.size(), 8U);
    EXPECT_TRUE(found.mismatch.leaked);
    const TemporaryFolder folder;
    write_case(folder.path() / "case", found, "closed mesh", "mine");
    const rays::RaySet written = rays::read_ray_file(folder.path() / "case" / "ray.rays");
    EXPECT_TRUE(written.must_hit);
    EXPECT_TRUE(written.may_graze);
    EXPECT_EQ(verify_tracer(found.scene, rays::TraceInput(written), exhaustive()).faults(), 0U);
    EXPECT_EQ(verify_tracer(found.scene, rays::TraceInput(written), leaking()).leaks, 1U);
  }
}

TEST_F(Minimize, FaultsThatDisappearAreNotReduced) {
  const Tracer wrong = losing([](auto&, auto&, auto&, std::size_t) { return true; });
  const DiffReport report = verify_tracer(scene_, list_, wrong);
  base::Progress progress(1);
  EXPECT_FALSE(
      minimize(scene_, list_, report.examples.front(), wrong_by_differ(exhaustive()), progress));
}

TEST_F(Minimize, ImpossibleNumbersAreAlsoFaults) {
  const Tracer wrong = [](const scenes::Scene& scene, const rays::TraceInput& input) {
    rays::HitTable hits = exhaustive()(scene, input);
    for (auto& id : hits.primitives) {
      if (id != scenes::kNoPrimitive) id += 100'000;
    }
    return hits;
  };
  const auto first = wrong_by_differ(wrong)(scene_, list_, nullptr);
  ASSERT_TRUE(first);
  base::Progress progress(1);
  const auto found = minimize(scene_, list_, *first, wrong_by_differ(wrong), progress);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->primitives.size(), 1U);
}

TEST_F(Minimize, TheCaseIsWrittenAndReadsBack) {
  const TemporaryFolder folder;
  const MinimalCase found =
      reduced(scene_, list_, losing([](auto&, auto&, auto&, std::size_t) { return true; }));
  write_case(folder.path() / "new" / "case", found, "tetra:n=3", "mine");
  const auto at = [&](const char* name) { return folder.path() / "new" / "case" / name; };
  const scenes::Scene read = scenes::load_scene(at("scene.nff").string());
  EXPECT_EQ(scenes::scene_hash(read), scenes::scene_hash(found.scene));
  EXPECT_EQ(scenes::load_scene(at("scene.obj").string()).primitives.size(), 1U);
  for (const char* name : {"ray.rays", "ray.csv"}) {
    const rays::RaySet set = rays::read_ray_file(at(name));
    ASSERT_EQ(set.rays.size(), 1U);
    EXPECT_EQ(set.rays[0].direction, found.mismatch.ray.direction);
    EXPECT_EQ(set.rays[0].t_max, found.mismatch.ray.t_max);
  }
  const auto json = nlohmann::json::parse(read_text(at("case.json")));
  EXPECT_EQ(json["subject"], "mine");
  EXPECT_EQ(json["wrong"]["class"], "structure_error");
  EXPECT_EQ(json["primitives"].size(), 1U);
}

TEST(Subset, OfAllPrimitivesIsTheSceneAndOfSomeHasTheirBits) {
  for (const char* name : {"balls:n=2", "tree:n=3", "gears:n=2", "teapot:n=2"}) {
    const scenes::Scene scene = scenes::load_scene(name);
    std::vector<scenes::PrimitiveId> all(scene.primitives.size());
    std::iota(all.begin(), all.end(), 0U);
    EXPECT_EQ(scenes::scene_hash(scenes::subset(scene, all)), scenes::scene_hash(scene)) << name;
    const std::vector<scenes::PrimitiveId> some{all.back(), 0, 2};
    const scenes::Scene part = scenes::subset(scene, some);
    ASSERT_EQ(part.primitives.size(), 3U);
    for (scenes::PrimitiveId i = 0; i < 3; ++i) {
      const scenes::Bounds box = scenes::primitive_bounds(part, i);
      const scenes::Bounds expected = scenes::primitive_bounds(scene, some[i]);
      EXPECT_EQ(box.lower, expected.lower) << name;
      EXPECT_EQ(box.upper, expected.upper) << name;
      EXPECT_TRUE(glm::all(glm::lessThanEqual(part.bounds.lower, box.lower)));
    }
  }
}

// Commands

TEST_F(Minimize, ACommandIsRunWithItsFiles) {
  const std::string program =
      std::string(BEAMBENCH_BINARY) + " hits {nff} --rays {rays} --accel samet -o {hits}";
  EXPECT_EQ(verify_tracer(scene_, list_, program_of(program)).verdict, Verdict::kOk);
  const std::string csv =
      std::string(BEAMBENCH_BINARY) +
      " hits {nff} --rays {rays_csv} -o {hits}.csv && mv {hits}.csv {hits} && test -s {obj}";
  EXPECT_EQ(verify_tracer(scene_, list_, program_of(csv)).verdict, Verdict::kOk);
}

TEST_F(Minimize, ACommandThatFailsIsNamed) {
  const TemporaryFolder folder;  // files of commands that fail are kept
  ::setenv("TMPDIR", folder.path().c_str(), 1);
  const auto refusal = [&](const char* command) {
    return scenes::thrown_message([&] { program_of(command)(scene_, list_); });
  };
  EXPECT_TRUE(scenes::says(refusal("true"), {"no {hits}"}));
  EXPECT_TRUE(scenes::says(refusal("exit 3; {hits}"), {"ended with exit code 3"}));
  EXPECT_TRUE(scenes::says(refusal("kill -9 $$; {hits}"), {"was ended by SIGKILL"}));
  EXPECT_TRUE(
      scenes::says(refusal("sh -c 'kill -SEGV $$'; exit $?; {hits}"), {"crashed (SIGSEGV"}));
  EXPECT_TRUE(scenes::says(refusal("test ! -e {hits}"), {"wrote no hits"}));
  EXPECT_TRUE(scenes::says(refusal("printf 't,primitive\\n1,2\\n' > {hits}"),
                           {"wrote 1 hits for 480 rays"}));

  // The message quotes the command as run, and the command's files still exist.
  const std::string message = refusal("test -s {obj} && exit 3; {hits}");
  const std::size_t begin = message.find("test -s ") + 8;
  const std::string obj = message.substr(begin, message.find(' ', begin) - begin);
  EXPECT_TRUE(std::filesystem::exists(obj)) << message;
  EXPECT_TRUE(scenes::says(message, {"its files are kept"}));
  ::unsetenv("TMPDIR");
}

}  // namespace
}  // namespace beambench::verify

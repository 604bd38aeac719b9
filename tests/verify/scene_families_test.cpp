// Awkward scenes: no structure fails on them, with any kind of rays, on any instruction set.
//
// In the environment, BEAMBENCH_FAMILY_SCENES=1000 requests more scenes, and
// BEAMBENCH_FAMILY_SEED=N selects others.

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "accel/core/registry.hpp"
#include "harness/rays/trace_results.hpp"
#include "harness/render/verified_picture.hpp"
#include "harness/verify/describe.hpp"
#include "harness/verify/selftest/subject.hpp"
#include "harness/verify/selftest/test_scenes.hpp"
#include "scenes/base/error.hpp"
#include "tests/number_from.hpp"
#include "tests/only_target.hpp"
#include "tests/verify/exact_answers.hpp"

namespace beambench::verify {
namespace {

/// A structure restricted to one instruction set.
struct Contender {
  std::string label;
  accel::StructureChoice choice;
  std::unique_ptr<accel::Accelerator> structure;

  accel::Conformance conformance() const { return choice.info().conformance; }
};

/// Returns every structure, with its defaults or with random parameters, on every instruction set
/// to which it can be restricted.
std::vector<Contender> contenders_over(const scenes::Scene& scene, Random& random) {
  std::vector<Contender> all;
  for (const accel::StructureInfo& info : accel::registry().structures()) {
    if (info.conformance == accel::Conformance::kBaseline) continue;
    const bool varied = random.below(2) == 0;
    const auto isa =
        std::ranges::find(info.parameters, "isa", [](const auto& each) { return each.name; });
    const std::vector<std::string> sets =
        isa == info.parameters.end() ? std::vector<std::string>{""} : isa->choices;
    const Random before = random;
    for (const std::string& set : sets) {
      random = before;  // the same parameters for all instruction sets
      Spec spec{info.name, {}};
      const Parameters chosen =
          varied ? random_parameters(info, random) : Parameters(info.name, info.parameters, {});
      for (const auto& [name, value] : parse_spec(chosen.label()).parameters) {
        if (name != "isa") spec.parameters.emplace_back(name, value);
      }
      if (!set.empty()) spec.parameters.emplace_back("isa", set);
      try {
        const accel::StructureChoice choice = accel::registry().choose(spec);
        all.push_back({choice.short_label(), choice, choice.build(scene)});
      } catch (const InputError&) {  // this machine lacks the instruction set, or a cap is exceeded
      }
    }
  }
  return all;
}

std::string first_error(const scenes::Scene& scene, const rays::TraceInput& input,
                        const DiffReport& report) {
  for (const Mismatch& example : report.examples) {
    if (example.diff_class == DiffClass::kStructureError) return describe(scene, input, example);
  }
  return "";
}

constexpr const char* kKinds[] = {"primary", "shadow",       "reflection",     "mirror",
                                  "diffuse", "ao:samples=4", "path:bounces=3", "random"};

/// One scene with its rays, and the results of the structures.
class Trial {
 public:
  explicit Trial(std::uint64_t seed) : scene_(family_scene(seed)), random_(seed) {
    constexpr int kWidths[] = {8, 15, 16, 17, 24, 33};
    const rays::Resolution resolution{kWidths[random_.below(6)], 14};
    const int samples = random_.below(4) == 0 ? 5 : 1;
    const rays::ImageOfRays image{scene_.cameras.front(), resolution, samples};
    for (const char* kind : kKinds) {
      try {
        references_.emplace_back(
            scene_, rays::make_trace_input(scene_, image, rays::parse_ray_choice(kind)));
      } catch (const InputError&) {  // there are no hits for rays to start from
      }
    }
  }

  void verify_all() {
    for (const Contender& contender : contenders_over(scene_, random_)) {
      for (const ReferenceHits& reference : references_) verify_rays(contender, reference);
      verify_picture_of(contender);
    }
  }
  std::size_t verified() const { return verified_; }

 private:
  void verify_rays(const Contender& contender, const ReferenceHits& reference) {
    const rays::TraceInput& input = reference.input();
    if (!rays::is_supported(contender.choice, input)) return;
    rays::TraceResults results = rays::make_results(input);
    rays::poison(results);
    rays::trace(*contender.structure, input, results);
    const DiffReport report = verify_results(reference, results, contender.conformance());
    verified_ += report.rays;
    EXPECT_EQ(report.count(DiffClass::kStructureError), 0U)
        << contender.label << " over " << scene_.name << ", " << input.label() << " rays\n"
        << first_error(scene_, input, report);
    if (contender.conformance() == accel::Conformance::kBitExact) {
      const auto [exact, first] = exact_.try_emplace(input.label(), results);
      EXPECT_TRUE(first || exact->second == results)
          << contender.label << " over " << scene_.name << ", " << input.label()
          << " rays: bits differ from exhaustive";
    }
  }

  void verify_picture_of(const Contender& contender) {
    if (!contender.choice.info().support.batches) return;
    const ReferenceHits& eye = references_.front();
    const accel::PrimaryRays& rays = *eye.input().image();
    accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
    contender.structure->closest_hits(rays, hits, {});
    std::vector<render::VerifiedRays> verified;
    try {
      verified = render::verify_recorded_picture(
          eye,
          render::record_picture(std::make_shared<const render::ShadedScene>(scene_),
                                 *contender.structure, rays, hits, {}, rays::HitCheck(scene_)),
          contender.conformance());
    } catch (const rays::InvalidHit& error) {
      ADD_FAILURE() << contender.label << " over " << scene_.name << ": " << error.what();
    }
    for (const render::VerifiedRays& of_kind : verified) {
      verified_ += of_kind.report.rays;
      EXPECT_EQ(of_kind.report.count(DiffClass::kStructureError), 0U)
          << contender.label << " over " << scene_.name << ", whitted " << of_kind.kind << " rays\n"
          << first_error(scene_, of_kind.input, of_kind.report);
    }
  }

  scenes::Scene scene_;
  Random random_;
  std::vector<ReferenceHits> references_;
  std::map<std::string, rays::TraceResults> exact_;  ///< of exhaustive, by kinds of rays
  std::size_t verified_ = 0;
};

TEST(SceneFamilies, AllStructuresAreCorrect) {
  const std::uint64_t scenes = tests::number_from("BEAMBENCH_FAMILY_SCENES", 28);
  const std::uint64_t first = tests::number_from("BEAMBENCH_FAMILY_SEED", 1);
  std::size_t verified = 0;
  for (std::uint64_t seed = first; seed < first + scenes; ++seed) {
    SCOPED_TRACE(fmt::format("seed {}", seed));
    Trial trial(seed);
    trial.verify_all();
    verified += trial.verified();
  }
  fmt::print("{} scenes, {} results\n", scenes, verified);
  EXPECT_GT(verified, scenes * 10'000);
}

/// Returns the image of a structure compiled for one of Highway's targets.
accel::HitBuffer image_on(std::int64_t target, const std::string& name, const scenes::Scene& scene,
                          const accel::PrimaryRays& rays) {
  const tests::OnlyTarget only(target);
  const auto structure = accel::registry().choose({name, {}}).build(scene);
  accel::HitBuffer image(rays.width(), rays.height(), rays.samples());
  rays::poison(image);
  structure->closest_hits(rays, image, {});
  return image;
}

/// Compares every instruction set with every other, sample by sample: equal bits for bit-exact
/// structures, otherwise both correct by the exact crossings.
TEST(SceneFamilies, EveryInstructionSetReturnsTheSameHits) {
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  ASSERT_GE(targets.size(), 2U);
  std::size_t compared = 0;
  for (std::uint64_t seed = 1; seed <= 21; ++seed) {
    const scenes::Scene scene = family_scene(seed);
    for (const auto& [width, samples] : {std::pair{9, 1}, {16, 1}, {33, 1}, {20, 4}, {7, 5}}) {
      const accel::PrimaryRays rays(scene.cameras.front(), width, 17, samples);
      const rays::TraceInput input(rays);
      for (const char* name : {"tile-beam", "sah-bvh", "beam"}) {
        std::vector<accel::HitBuffer> images;
        for (const std::int64_t target : targets) {
          images.push_back(image_on(target, name, scene, rays));
        }
        for (std::size_t a = 0; a < images.size(); ++a) {
          for (std::size_t b = a + 1; b < images.size(); ++b) {
            SCOPED_TRACE(fmt::format("{} over {}, seed {}, {}x17x{}: {} and {}", name, scene.name,
                                     seed, width, samples, hwy::TargetName(targets[a]),
                                     hwy::TargetName(targets[b])));
            if (std::string(name) != "tile-beam") {
              ASSERT_EQ(images[a], images[b]);
              continue;
            }
            for (std::size_t i = 0; i < images[a].size(); ++i) {
              const auto one = images[a].get(i);
              const auto other = images[b].get(i);
              if (one == other) continue;
              ++compared;
              ASSERT_TRUE(tests::class_of(scene, input.ray(i), one) &&
                          tests::class_of(scene, input.ray(i), other))
                  << rays::place_text(input, i) << ": primitive "
                  << (one ? one->primitive : scenes::kNoPrimitive) << " at "
                  << (one ? one->t : accel::kInfinity) << " and primitive "
                  << (other ? other->primitive : scenes::kNoPrimitive) << " at "
                  << (other ? other->t : accel::kInfinity);
            }
          }
        }
      }
    }
  }
  EXPECT_GT(compared, 0U) << "no two instruction sets round differently: are they different?";
}

TEST(SceneFamilies, AreDeterminedByTheSeedAndHaveOnlySupportedKinds) {
  for (std::uint64_t seed = 0; seed < 70; ++seed) {
    const scenes::Scene scene = family_scene(seed);
    EXPECT_EQ(scenes::scene_hash(scene), scenes::scene_hash(family_scene(seed))) << seed;
    EXPECT_TRUE(scene.name.starts_with(kSceneFamilies[seed % kSceneFamilies.size()])) << seed;
    EXPECT_GE(scene.primitives.size(), 3U) << scene.name;
    for (const PrimitiveKinds kinds :
         {PrimitiveKinds{true, false, false}, PrimitiveKinds{false, true, false},
          PrimitiveKinds{false, false, true}, PrimitiveKinds{true, true, false}}) {
      const scenes::Scene of_kinds = family_scene(seed, kinds);
      EXPECT_TRUE(kinds.include(of_kinds)) << of_kinds.name;
      EXPECT_FALSE(of_kinds.primitives.empty()) << of_kinds.name;
    }
  }
}

}  // namespace
}  // namespace beambench::verify

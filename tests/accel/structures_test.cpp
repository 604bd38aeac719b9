// What must be true of every structure in the registry: a new one is tested by being registered.

#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "accel/exhaustive/exhaustive.hpp"
#include "accel/registry.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/error.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/random_scene.hpp"

namespace beambench {
namespace {

using testing::random_ray;
using testing::random_scene;

/// Values near the lower end of each parameter's range; defaults for reals and for large caps.
Parameters random_parameters(const StructureInfo& info, Random& random) {
  std::vector<std::pair<std::string, std::string>> given;
  for (const ParameterInfo& parameter : info.parameters) {
    switch (parameter.type) {
      case ParameterInfo::Type::kInteger:
        if (std::stod(parameter.default_value) <= 1000.0) {
          const auto low = static_cast<std::uint64_t>(parameter.minimum);
          const auto high = static_cast<std::uint64_t>(parameter.maximum);
          given.emplace_back(parameter.name, std::to_string(std::min(low + random.below(9), high)));
        }
        break;
      case ParameterInfo::Type::kFlag:
        given.emplace_back(parameter.name, random.below(2) == 0 ? "false" : "true");
        break;
      case ParameterInfo::Type::kChoice:
        given.emplace_back(parameter.name,
                           parameter.choices[random.below(parameter.choices.size())]);
        break;
      case ParameterInfo::Type::kCells:
        if (random.below(4) != 0) {
          given.emplace_back(parameter.name,
                             fmt::format("{}x{}x{}", 1 + random.below(20), 1 + random.below(20),
                                         1 + random.below(20)));
        }
        break;
      case ParameterInfo::Type::kReal:
        break;
    }
  }
  return {info.name, info.parameters, given};
}

std::string show(const std::optional<Hit>& hit) {
  return hit ? fmt::format("t {:a} primitive {}", hit->t, hit->primitive) : "miss";
}

std::string show(const Ray& ray) {
  return fmt::format("origin ({:a}, {:a}, {:a}) direction ({:a}, {:a}, {:a}) t [{:a}, {:a}]",
                     ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y,
                     ray.direction.z, ray.t_min, ray.t_max);
}

/// Compares closest and any hit of one ray, and of the ray cut exactly at its hit.
void expect_same_bits(const Accelerator& expected, const Accelerator& actual, Ray ray) {
  const auto hit = expected.closest_hit(ray);
  EXPECT_EQ(actual.closest_hit(ray), hit) << show(ray) << "\n  expected " << show(hit)
                                          << "\n  actual   " << show(actual.closest_hit(ray));
  EXPECT_EQ(actual.any_hit(ray), hit.has_value()) << "any hit, " << show(ray);
  if (!hit) return;
  ray.t_max = hit->t;
  EXPECT_EQ(actual.closest_hit(ray), hit) << "t_max at the hit, " << show(ray);
  EXPECT_TRUE(actual.any_hit(ray)) << "t_max at the hit, " << show(ray);
  ray.t_max = kInfinity;
  ray.t_min = hit->t;
  EXPECT_EQ(actual.closest_hit(ray), expected.closest_hit(ray))
      << "t_min at the hit, " << show(ray);
}

std::vector<std::string> names_with(Conformance conformance) {
  std::vector<std::string> names;
  for (const auto& info : registry().structures()) {
    if (info.conformance == conformance) names.push_back(info.name);
  }
  return names;
}

std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class BitExact : public ::testing::TestWithParam<std::string> {
 protected:
  const StructureInfo& info() const { return registry().choose({GetParam(), {}}).info(); }
};

TEST_P(BitExact, EqualsExhaustiveOnRandomScenes) {
  constexpr std::uint64_t kScenes = 240;
  constexpr int kRays = 300;
  std::uint64_t hits = 0;
  for (std::uint64_t seed = 1; seed <= kScenes; ++seed) {
    Random random(seed);
    const Scene scene = random_scene(seed, static_cast<int>(1 + random.below(60)));
    const Exhaustive exhaustive(scene);
    const StructureChoice choice(info(), random_parameters(info(), random));
    SCOPED_TRACE(fmt::format("seed {} {}", seed, choice.label()));
    const auto structure = choice.build(scene);
    for (int i = 0; i < kRays; ++i) {
      const Ray ray = random_ray(scene, random);
      expect_same_bits(exhaustive, *structure, ray);
      if (exhaustive.any_hit(ray)) ++hits;
    }
    if (HasFailure()) return;
  }
  // The rays must be worth asking: neither all misses nor all hits.
  EXPECT_GT(hits, kScenes * kRays / 5);
  EXPECT_LT(hits, kScenes * kRays * 4 / 5);
}

TEST_P(BitExact, EqualsExhaustiveOnCatalogueImages) {
  for (const char* name : {"tetra:n=3", "balls:n=2", "escena1", "escena2", "bumpy:triangles=768"}) {
    SCOPED_TRACE(name);
    const Scene scene = load_scene(name);
    const auto structure = registry().choose({GetParam(), {}}).build(scene);
    for (const int samples : {1, 5}) {
      const PrimaryRays rays(scene.cameras.front(), 41, 33, samples);
      HitBuffer expected(41, 33, samples);
      HitBuffer actual(41, 33, samples);
      Exhaustive(scene).trace(rays, expected);
      structure->trace(rays, actual);
      EXPECT_EQ(actual, expected);
    }
  }
}

TEST_P(BitExact, CountingChangesNoHit) {
  const Scene scene = random_scene(7, 40);
  const auto structure = registry().choose({GetParam(), {}}).build(scene);
  Random random(7);
  WorkCounters counters;
  for (int i = 0; i < 500; ++i) {
    const Ray ray = random_ray(scene, random);
    EXPECT_EQ(structure->closest_hit(ray, counters), structure->closest_hit(ray));
    EXPECT_EQ(structure->any_hit(ray, counters), structure->any_hit(ray));
  }
  EXPECT_GT(counters.get(Counter::kPrimitiveTests), 0U);
}

TEST_P(BitExact, TakesAnEmptyScene) {
  const Scene scene = SceneBuilder("empty").build();
  const auto structure = registry().choose({GetParam(), {}}).build(scene);
  EXPECT_EQ(structure->closest_hit(Ray{}), std::nullopt);
  EXPECT_FALSE(structure->any_hit(Ray{}));
}

TEST_P(BitExact, TakesManyPrimitivesInOnePlace) {
  SceneBuilder builder("heap");
  for (int i = 0; i < 10'000; ++i) builder.add_sphere({0.25, 0.5, -0.125}, 0.5);
  const Scene scene = std::move(builder).build();
  const auto structure = registry().choose({GetParam(), {}}).build(scene);
  Ray ray;
  ray.origin = {0.25F, 0.5F, 4.0F};
  const auto hit = structure->closest_hit(ray);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->primitive, 0U);
  EXPECT_EQ(hit->t, 3.625F);
}

INSTANTIATE_TEST_SUITE_P(All, BitExact, ::testing::ValuesIn(names_with(Conformance::kBitExact)),
                         test_name);

TEST(Registry, NamesTheValidStructures) {
  try {
    registry().choose(parse_spec("sammet:max_level=5"));
    FAIL() << "an unknown structure was accepted";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("'sammet'"), std::string::npos) << message;
    EXPECT_NE(message.find("did you mean 'samet'"), std::string::npos) << message;
    EXPECT_NE(message.find("exhaustive"), std::string::npos) << message;
  }
}

TEST(Registry, EveryStructureExplainsItself) {
  for (const auto& info : registry().structures()) {
    EXPECT_FALSE(info.summary.empty()) << info.name;
    for (const auto& parameter : info.parameters) {
      EXPECT_FALSE(parameter.description.empty()) << info.name << ' ' << parameter.name;
    }
  }
}

TEST(Null, AnswersNothing) {
  const Scene scene = random_scene(3, 10);
  const auto null = registry().choose({"null", {}}).build(scene);
  HitBuffer buffer(8, 8, 1);
  null->trace(PrimaryRays(scene.cameras.front(), 8, 8, 1), buffer);
  EXPECT_EQ(buffer, HitBuffer(8, 8, 1));
}

}  // namespace
}  // namespace beambench

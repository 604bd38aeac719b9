// What must be true of every structure in the registry: a new one is tested by being registered.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <thread>
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
      case ParameterInfo::Type::kIntegerOrAuto:
        if (random.below(4) == 0) {
          given.emplace_back(parameter.name, "auto");
          break;
        }
        [[fallthrough]];
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

std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const auto& info : registry().structures()) names.push_back(info.name);
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

TEST_P(BitExact, TakesOneObject) {
  for (int kind = 0; kind < 3; ++kind) {
    SceneBuilder builder("one");
    if (kind == 0) builder.add_sphere({0.5, -0.25, 2.0}, 0.75);
    if (kind == 1) builder.add_cone({0.0, 0.0, 0.0}, 0.5, {0.0, 1.0, 0.0}, 0.25);
    if (kind == 2) {  // flat along an axis: bounds without a volume
      const std::vector<glm::dvec3> corners{{0.0, 0.0, 1.0}, {2.0, 0.0, 1.0}, {0.0, 1.0, 1.0}};
      builder.add_polygon(corners);
    }
    const Scene scene = std::move(builder).build();
    SCOPED_TRACE(kind);
    const auto structure = registry().choose({GetParam(), {}}).build(scene);
    Random random(1);
    for (int i = 0; i < 300; ++i) {
      expect_same_bits(Exhaustive(scene), *structure, random_ray(scene, random));
    }
  }
}

// Cubes on a lattice whose planes are those of cells: rays along axes and diagonals, from outside
// and inside, run in faces and through edges and vertices.
TEST_P(BitExact, TakesRaysThroughFacesEdgesAndVertices) {
  SceneBuilder builder("cubes");
  for (int cube = 0; cube < 8; ++cube) {
    const glm::dvec3 lower(2.0 * (cube & 1), 2.0 * (cube >> 1 & 1), 2.0 * (cube >> 2));
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {0.0, 1.0}) {
        glm::dvec3 corner = lower;
        corner[axis] += side;
        std::vector<glm::dvec3> corners(4, corner);
        corners[1][(axis + 1) % 3] += 1.0;
        corners[2][(axis + 1) % 3] += 1.0;
        corners[2][(axis + 2) % 3] += 1.0;
        corners[3][(axis + 2) % 3] += 1.0;
        builder.add_polygon(corners);
      }
    }
  }
  const Scene scene = std::move(builder).build();
  const Exhaustive exhaustive(scene);
  const auto structure = registry().choose({GetParam(), {}}).build(scene);
  const auto digit = [](int number, int place) { return number / place % 3 - 1; };
  for (int from = 0; from < 9 * 9 * 9; ++from) {
    const glm::ivec3 place(from % 9, from / 9 % 9, from / 81);
    for (int way = 0; way < 27; ++way) {
      if (way == 13) continue;
      Ray ray;
      ray.origin = glm::vec3(place) * 0.75F - 1.5F;
      ray.direction = {digit(way, 1), digit(way, 3), digit(way, 9)};
      expect_same_bits(exhaustive, *structure, ray);
    }
    if (HasFailure()) return;
  }
}

TEST_P(BitExact, AnswersSeveralThreadsAtOnce) {
  const Scene scene = random_scene(11, 60);
  const Exhaustive exhaustive(scene);
  Random random(11);
  std::vector<Ray> rays;
  std::vector<std::optional<Hit>> expected;
  for (int i = 0; i < 1000; ++i) {
    rays.push_back(random_ray(scene, random));
    expected.push_back(exhaustive.closest_hit(rays.back()));
  }
  const auto structure = registry().choose({GetParam(), {}}).build(scene);
  std::array<int, 4> wrong{};
  {
    std::vector<std::jthread> threads;
    threads.reserve(wrong.size());
    for (int& mine : wrong) {
      threads.emplace_back([&] {
        for (std::size_t i = 0; i < rays.size(); ++i) {
          if (structure->closest_hit(rays[i]) != expected[i]) ++mine;
          if (structure->any_hit(rays[i]) != expected[i].has_value()) ++mine;
        }
      });
    }
  }
  EXPECT_EQ(wrong, (std::array<int, 4>{}));
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

// Rays within the faces and along the edges of every box there is.
TEST_P(BitExact, TakesRaysAlongTheEdgesOfABlock) {
  SceneBuilder builder("block");
  for (int axis = 0; axis < 3; ++axis) {
    for (int x = 0; x < 4; ++x) {
      for (int y = 0; y < 4; ++y) {
        const auto corner = [&](int u, int v) {
          glm::dvec3 point(0.0);
          point[(axis + 1) % 3] = u;
          point[(axis + 2) % 3] = v;
          return point;
        };
        builder.add_polygon(std::array<glm::dvec3, 4>{corner(x, y), corner(x + 1, y),
                                                      corner(x + 1, y + 1), corner(x, y + 1)});
      }
    }
  }
  const Scene scene = std::move(builder).build();
  const Exhaustive exhaustive(scene);
  const auto structure = registry().choose({GetParam(), {}}).build(scene);
  for (int axis = 0; axis < 3; ++axis) {
    for (const float way : {-1.0F, 1.0F}) {
      for (int u = -1; u <= 9; ++u) {
        for (int v = -1; v <= 9; ++v) {
          Ray ray;
          ray.origin[axis] = -3.0F * way;
          ray.origin[(axis + 1) % 3] = 0.5F * static_cast<float>(u);
          ray.origin[(axis + 2) % 3] = 0.5F * static_cast<float>(v);
          for (const float zero : {0.0F, -0.0F}) {
            ray.direction = glm::vec3(zero);
            ray.direction[axis] = way;
            expect_same_bits(exhaustive, *structure, ray);
          }
        }
      }
    }
  }
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

class EveryStructure : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryStructure, AnswersListsAsItAnswersSingleRays) {
  const Scene scene = random_scene(11, 40);
  Random random(11);
  std::vector<Ray> rays;
  for (int i = 0; i < 203; ++i) {  // no multiple of a packet's size
    rays.push_back(random_ray(scene, random));
    if (i % 3 == 0) rays.back().t_max = 0.5F * static_cast<float>(i);
  }
  const auto structure = registry().choose({GetParam(), {}}).build(scene);
  HitBuffer closest(static_cast<int>(rays.size()), 1, 1);
  HitBuffer counted = closest;
  std::vector<std::uint8_t> any(rays.size(), 0xFF);
  std::vector<std::uint8_t> counted_any(rays.size(), 0xFF);
  WorkCounters counters;
  structure->closest_hits(rays, closest);
  structure->closest_hits(rays, counted, counters);
  structure->any_hits(rays, any);
  structure->any_hits(rays, counted_any, counters);
  EXPECT_EQ(counted, closest);
  EXPECT_EQ(counted_any, any);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(closest.get(i), structure->closest_hit(rays[i])) << show(rays[i]);
    if (!closest.get(i)) {
      EXPECT_EQ(closest.t()[i], kInfinity);
    }
    EXPECT_EQ(any[i], structure->any_hit(rays[i]) ? 1 : 0) << show(rays[i]);
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryStructure, ::testing::ValuesIn(all_names()), test_name);

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

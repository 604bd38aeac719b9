// Properties of light in a divided scene: every ray finds the same hit as in one process, so the
// picture is the same, bit for bit.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "accel/beam/beam_tracer.hpp"
#include "harness/render/whitted_picture.hpp"
#include "harness/thesis/cluster/split/light_run.hpp"
#include "harness/thesis/cluster/split/part_member.hpp"
#include "harness/thesis/cluster/split/split_run.hpp"
#include "harness/verify/selftest/test_scenes.hpp"
#include "scenes/catalogue.hpp"
#include "scenes/scene_builder.hpp"
#include "tests/thesis/cluster/beam_options.hpp"
#include "tests/thesis/cluster/followers.hpp"
#include "tests/thesis/cluster/local_network.hpp"
#include "tests/thesis/cluster/scene_divisions.hpp"

namespace beambench::cluster {
namespace {

using tests::kSceneDivisions;
using tests::options_with;
using verify::SceneWithRays;

/// A scene divided into parts, each handled as if in a separate process.
class Parts {
 public:
  Parts(const scenes::Scene& scene, const accel::beam::BeamOptions& options,
        const accel::PrimaryRays& rays, int level, SceneDivision division, LocalNetwork& network)
      : split_(split_scene(scene, options.octree, rays, level, division,
                           network.at(kProducer).processes())) {
    for (ProcessId self = 0; self < network.at(kProducer).processes(); ++self) {
      outboxes_.push_back(std::make_unique<Outbox>(network.at(self), split_));
      workers_.push_back(std::make_unique<PartWorker>(part_of(scene, split_, self), split_, self,
                                                      options, rays, *outboxes_.back()));
    }
  }

  const SceneSplit& split() const { return split_; }
  const PartWorker& at(ProcessId process) const {
    return *workers_[static_cast<std::size_t>(process)];
  }

  /// Takes a ray from part to part, starting in process `first`.
  accel::Hit traced(const accel::Ray& ray, LightQuery query, ProcessId first) const {
    const PartTracer& tracer = at(first).single_rays();
    const auto begin = tracer.beginning(ray);
    if (!begin) return kNoHit;
    LightRay light{0, 0, query, ray, 0.0, kNoHit};
    PartTracer::Passage passage = pass(tracer, light, *begin);
    while (passage.exit) {
      light.best = passage.best;
      const PartTracer& next = at(split_.owner(passage.exit->cell)).single_rays();
      passage = pass(next, light, next.entry(passage.exit->cell, passage.exit->t));
    }
    return passage.best;
  }

 private:
  SceneSplit split_;
  std::vector<std::unique_ptr<Outbox>> outboxes_;
  std::vector<std::unique_ptr<PartWorker>> workers_;
};

void expect_the_hits_of_one_process(const SceneWithRays& given, int level, int processes) {
  const accel::beam::BeamOptions options = options_with(5);
  const accel::PrimaryRays image(given.scene.cameras.front(), 8, 8, 1);
  const accel::beam::BeamTracer whole(given.scene, options);
  for (const SceneDivision division : kSceneDivisions) {
    LocalNetwork network(processes, 1, 0.0);
    const Parts parts(given.scene, options, image, level, division, network);
    for (std::size_t i = 0; i < given.rays.size(); ++i) {
      const accel::Ray& ray = given.rays[i];
      const auto first = static_cast<ProcessId>(i % static_cast<std::size_t>(processes));
      const accel::Hit expected = whole.closest_hit(ray, nullptr).value_or(kNoHit);
      ASSERT_EQ(parts.traced(ray, LightQuery::kClosest, first), expected) << "ray " << i;
      const bool any = parts.traced(ray, LightQuery::kAny, first).primitive != kNoHit.primitive;
      ASSERT_EQ(any, whole.any_hit(ray, nullptr)) << "ray " << i;
    }
  }
}

/// Every fourth scene has duplicate primitives: the lowest id of the whole scene is hit.
TEST(PartTracer, FindsTheHitsOfOneProcessForAnyRay) {
  for (std::uint64_t seed = 0; seed < 16; ++seed) {
    scenes::Scene scene = verify::random_scene(seed, 80);
    Random random(seed);
    std::vector<accel::Ray> rays = verify::random_rays(scene, 1500, random);
    const int level = 2 + static_cast<int>(seed % 4);
    expect_the_hits_of_one_process({std::move(scene), std::move(rays)}, level, 4);
  }
}

TEST(PartTracer, FindsTheHitsOfOneProcessOnBorders) {
  for (const int level : {2, 4}) {
    expect_the_hits_of_one_process(verify::cubes_on_a_lattice(), level, 3);
    expect_the_hits_of_one_process(verify::block_of_squares(), level, 3);
  }
}

/// Returns two polygons on both sides of a border, closer to each other than the precision of t:
/// equal hits, found by different processes.
SceneWithRays ties_across_a_border() {
  constexpr double kAside = 1e-5;
  constexpr float kFar = 1000.0F;
  scenes::SceneBuilder builder("ties");
  builder.add_light({0.0, 0.0, 5.0});
  for (const double z : {kAside, -kAside}) {
    builder.add_polygon(
        std::array<glm::dvec3, 4>{{{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}}});
  }
  for (const double z : {-0.9, 0.9}) builder.add_sphere({0.0, 0.0, z}, 0.1);
  SceneWithRays made{std::move(builder).build(), {}};
  for (const float side : {-1.0F, 1.0F}) {
    for (int i = 0; i < 64; ++i) {
      const float x = -0.9F + 0.23F * static_cast<float>(i % 8);
      const float y = -0.9F + 0.23F * static_cast<float>(i / 8);
      made.rays.push_back({{x, y, side * kFar}, 0.0F, {0.0F, 0.0F, -side}, accel::kInfinity});
    }
  }
  return made;
}

TEST(PartTracer, ResolvesTiesByTheLowestIdOfTheWholeScene) {
  for (const int processes : {2, 3, 5}) {
    expect_the_hits_of_one_process(ties_across_a_border(), 2, processes);
  }
}

TEST(PartTracer, FindsTheHitsOfOneProcessForDegenerateRays) {
  scenes::Scene scene = verify::random_scene(3, 60);
  std::vector<accel::Ray> rays = verify::degenerate_rays(scene, 3);
  expect_the_hits_of_one_process({std::move(scene), std::move(rays)}, 3, 3);
}

/// Adds mirrors and glass to a scene that has neither.
scenes::Scene with_light(scenes::Scene scene, std::uint64_t seed) {
  Random random(seed);
  scene.surfaces = {
      {.color = {0.9F, 0.5F, 0.2F}, .diffuse = 0.8F},
      {.diffuse = 0.2F, .specular = 0.7F, .shine = 20.0F},
      {.diffuse = 0.1F, .specular = 0.2F, .transmittance = 0.8F, .refraction_index = 1.4F}};
  for (scenes::Primitive& primitive : scene.primitives) {
    primitive.surface = static_cast<decltype(primitive.surface)>(random.below(3));
  }
  if (seed % 2 == 0) scene.surfaces[2].transmittance = 0.0F;  // shadow rays that end at any hit
  scene.lights.clear();
  verify::add_lights(scene, random);
  return scene;
}

struct Drawing {
  scenes::Scene scene;
  accel::PrimaryRays rays;
  accel::beam::BeamOptions options;
  accel::HitBuffer hits;
  render::WhittedPicture expected;
};

Drawing drawing_of(scenes::Scene scene, int width, int height, int samples) {
  const accel::PrimaryRays rays(scene.cameras.front(), width, height, samples);
  const accel::beam::BeamOptions options = options_with(5);
  const accel::beam::BeamTracer whole(scene, options);
  accel::HitBuffer hits(width, height, samples);
  whole.closest_hits(rays, hits, {});
  const render::Whitted tracer(scene, whole, {});
  render::WhittedPicture picture = render::whitted_picture(tracer, rays, hits);
  return {std::move(scene), rays, options, std::move(hits), std::move(picture)};
}

/// Calls `lead(leader)` on process 0, while all others, as threads, trace the rays that enter their
/// parts.
template <class Lead>
auto led_light(const Parts& parts, LocalNetwork& network, Lead lead) {
  std::vector<std::jthread> others;
  for (ProcessId process = 1; process < network.at(kProducer).processes(); ++process) {
    others.emplace_back([&network, &parts, process] {
      serve_light(network.at(process), parts.at(process), parts.split(), 1.0);
    });
  }
  LightLeader leader(network.at(kProducer), parts.at(kProducer), parts.split(), 20.0);
  return lead(leader);
}

/// Draws a picture in a divided scene whose primary hits are known.
DrawnLight drawn_in_parts(const Drawing& drawing, int level, SceneDivision division, int processes,
                          unsigned seed) {
  LocalNetwork network(processes, seed, 0.0003);
  const Parts parts(drawing.scene, drawing.options, drawing.rays, level, division, network);
  return led_light(parts, network, [&](LightLeader& leader) {
    return leader.draw(drawing.scene, {}, rays::HitCheck(drawing.scene), drawing.rays,
                       drawing.hits);
  });
}

void expect_the_answers_of_one_process(const SceneWithRays& given, int level, int processes) {
  const accel::beam::BeamOptions options = options_with(5);
  const accel::PrimaryRays image(given.scene.cameras.front(), 8, 8, 1);
  const accel::beam::BeamTracer whole(given.scene, options);
  const auto count = static_cast<int>(given.rays.size());
  for (const SceneDivision division : kSceneDivisions) {
    LocalNetwork network(processes, 1, 0.0003);
    const Parts parts(given.scene, options, image, level, division, network);
    led_light(parts, network, [&](LightLeader& leader) {
      return leader.answer([&](const accel::Accelerator& divided) {
        accel::HitBuffer found(count, 1, 1);
        accel::HitBuffer expected(count, 1, 1);
        divided.closest_hits(accel::RayBatch{given.rays}, found, {});
        whole.closest_hits(accel::RayBatch{given.rays}, expected, {});
        EXPECT_TRUE(found == expected) << processes << " processes";
        std::vector<std::uint8_t> any(given.rays.size());
        divided.any_hits(accel::RayBatch{given.rays}, any, {});
        for (std::size_t i = 0; i < any.size(); ++i) {
          EXPECT_EQ(any[i], whole.any_hit(given.rays[i], nullptr) ? 1 : 0) << "ray " << i;
        }
        EXPECT_EQ(divided.closest_hit(given.rays[0], nullptr), expected.get(0));
        EXPECT_EQ(divided.any_hit(given.rays[0], nullptr), any[0] != 0);
      });
    });
  }
}

TEST(DividedScene, FindsTheHitsOfOneProcess) {
  for (const int processes : {1, 2, 5}) {
    expect_the_answers_of_one_process(ties_across_a_border(), 2, processes);
    expect_the_answers_of_one_process(verify::cubes_on_a_lattice(), 3, processes);
    scenes::Scene scene = verify::random_scene(5, 80);
    Random random(5);
    std::vector<accel::Ray> rays = verify::random_rays(scene, 500, random);
    expect_the_answers_of_one_process({std::move(scene), std::move(rays)}, 3, processes);
  }
}

void expect_the_picture_of_one_process(const Drawing& drawing, int level, unsigned seed) {
  for (int processes = 1; processes <= 5; ++processes) {
    const SceneDivision division = kSceneDivisions[(seed + static_cast<unsigned>(processes)) % 5];
    const DrawnLight drawn = drawn_in_parts(drawing, level, division, processes, seed);
    EXPECT_TRUE(std::ranges::equal(drawn.image.pixels(), drawing.expected.image.pixels()))
        << "seed " << seed << ", level " << level << ", " << processes << " processes, "
        << division_names()[static_cast<std::size_t>(division)];
    for (const render::CensusCount& each : render::kCensusCounts) {
      EXPECT_EQ(drawn.census.*each.count, drawing.expected.census.*each.count) << each.name;
    }
    std::uint64_t out = 0;
    std::uint64_t answers = 0;
    for (const LightReport& report : drawn.reports) {
      out += report.rays_out;
      answers += report.answers_out;
    }
    EXPECT_EQ(drawn.reports.size(), static_cast<std::size_t>(processes));
    EXPECT_LE(answers, out);
    if (processes == 1) {
      EXPECT_EQ(out, 0U);
    }
  }
}

TEST(SplitLight, IsThatOfOneProcessBitForBit) {
  std::uint64_t reflected = 0;
  std::uint64_t refracted = 0;
  std::uint64_t hidden = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const Drawing drawing =
        drawing_of(with_light(verify::random_scene(seed, 60), seed), 47, 33, seed % 3 == 0 ? 5 : 1);
    reflected += drawing.expected.census.reflected;
    refracted += drawing.expected.census.refracted;
    hidden += drawing.expected.census.shadow_hidden;
    expect_the_picture_of_one_process(drawing, 2 + static_cast<int>(seed % 4), seed);
  }
  EXPECT_GT(reflected, 1000U);
  EXPECT_GT(refracted, 1000U);
  EXPECT_GT(hidden, 1000U);
}

TEST(SplitLight, IsThatOfOneProcessInDifficultScenes) {
  for (unsigned seed = 0; seed < 2 * verify::kSceneFamilies.size(); ++seed) {
    expect_the_picture_of_one_process(drawing_of(verify::family_scene(seed), 40, 30, 1), 3, seed);
  }
}

TEST(SplitLight, RunsFromACommandLineToItsEnd) {
  const Drawing drawing = drawing_of(scenes::load_scene("balls:n=2"), 40, 30, 1);
  ClusterRequest request;
  request.job.scene = "balls:n=2";
  request.job.structure = "beam:max_level=5";
  request.job.resolution = {40, 30};
  request.job.split_level = 3;
  request.job.light = true;
  request.shading = render::Shading::kWhitted;
  LocalNetwork network(3, 1, 0.0);
  const SplitRun run = led(lead_split, request, network);
  EXPECT_EQ(run.result_hash, render::fingerprint(drawing.expected.image));
  ASSERT_EQ(run.light.size(), 3U);
  EXPECT_GT(run.light[0].rays_out, 0U);
  EXPECT_GT(run.light[1].answers_out + run.light[2].answers_out, 0U);
  EXPECT_GT(run.shading_bytes, 0U);
}

TEST(SplitLight, EndsWithAnErrorIfAProcessIsSilent) {
  const Drawing drawing = drawing_of(with_light(verify::random_scene(2, 60), 2), 60, 60, 1);
  LocalNetwork network(2, 1, 0.0);
  const Parts parts(drawing.scene, drawing.options, drawing.rays, 3, SceneDivision::kScattered,
                    network);
  network.mute_after(1, 1);
  std::jthread other([&] { serve_light(network.at(1), parts.at(1), parts.split(), 0.05); });
  LightLeader leader(network.at(kProducer), parts.at(kProducer), parts.split(), 0.3);
  EXPECT_THROW(
      leader.draw(drawing.scene, {}, rays::HitCheck(drawing.scene), drawing.rays, drawing.hits),
      LostProcess);
}

TEST(SplitLight, EndsWithAnErrorForAnInvalidHit) {
  Drawing drawing = drawing_of(with_light(verify::random_scene(2, 60), 2), 20, 20, 1);
  drawing.hits.set(7, accel::Hit{1.0F, 1U << 20U});
  EXPECT_THROW(drawn_in_parts(drawing, 3, SceneDivision::kScattered, 2, 1), rays::InvalidHit);
}

TEST(SplitLight, ReceivesHeartbeatsFromIdleProcesses) {
  const scenes::Scene scene = verify::random_scene(2, 60);
  const accel::PrimaryRays rays(scene.cameras.front(), 8, 8, 1);
  LocalNetwork network(2, 1, 0.0);
  const Parts parts(scene, options_with(5), rays, 3, SceneDivision::kPrimitives, network);
  std::jthread other([&] { serve_light(network.at(1), parts.at(1), parts.split(), 0.01); });
  for (int i = 0; i < 3; ++i) {
    const auto sign = network.at(kProducer).wait(5.0);
    ASSERT_TRUE(sign);
    EXPECT_EQ(sign->tag, Tag::kHeartbeat);
  }
  network.at(kProducer).send(1, Tag::kEnd, {});
}

TEST(LightExchange, ReturnsToEachThreadTheHitsOfItsRays) {
  LightExchange exchange;
  std::vector<std::jthread> threads;
  for (unsigned thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&exchange, thread] {
      for (unsigned round = 0; round < 50; ++round) {
        std::vector<LightRay> rays(1 + round % 7);
        for (std::size_t i = 0; i < rays.size(); ++i) {
          rays[i].ray.t_min = static_cast<float>(1000 * thread + 10 * round + i);
        }
        const std::vector<accel::Hit> hits = exchange.nearest_hits(rays);
        ASSERT_EQ(hits.size(), rays.size());
        for (std::size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(hits[i].t, rays[i].ray.t_min);
      }
    });
  }
  std::size_t missing = 0;
  for (unsigned round = 0; round < 50; ++round) missing += 4 * (1 + round % 7);
  while (missing > 0) {
    std::vector<LightRay> rays = exchange.take(std::chrono::milliseconds(1));
    std::ranges::reverse(rays);
    missing -= rays.size();
    for (const LightRay& ray : rays) exchange.answer({ray.number, {ray.ray.t_min, 0}});
  }
}

TEST(LightExchange, RefusesAnUnexpectedAnswer) {
  LightExchange exchange;
  EXPECT_THROW(exchange.answer({0, kNoHit}), ProtocolError);
  std::jthread asking([&] { exchange.nearest_hits(std::vector<LightRay>(1)); });
  std::vector<LightRay> rays;
  while (rays.empty()) rays = exchange.take(std::chrono::milliseconds(1));
  exchange.answer({rays.front().number, kNoHit});
  EXPECT_THROW(exchange.answer({rays.front().number, kNoHit}), ProtocolError);
}

TEST(LightExchange, ReleasesAllThreadsOnceItIsClosed) {
  LightExchange exchange;
  std::jthread asking(
      [&] { EXPECT_THROW(exchange.nearest_hits(std::vector<LightRay>(3)), std::runtime_error); });
  while (exchange.take(std::chrono::milliseconds(1)).empty()) {
  }
  exchange.close();
}

TEST(LightRays, WithInvalidFormsOrIndicesAreRefused) {
  const scenes::Scene scene = verify::random_scene(2, 60);
  const accel::PrimaryRays rays(scene.cameras.front(), 8, 8, 1);
  LocalNetwork network(2, 1, 0.0);
  const Parts parts(scene, options_with(5), rays, 3, SceneDivision::kPrimitives, network);
  LightOutbox outbox(network.at(0), parts.split());
  LightRelay relay(parts.at(0).single_rays(), parts.split(), 0, outbox, [](const LightAnswer&) {});
  for (std::uint32_t cell = 0; cell <= parts.split().cells().count(); ++cell) {
    const bool is_own = cell < parts.split().cells().count() && parts.split().owner(cell) == 0;
    Bytes message;
    write_light(LightRay{cell, 0, LightQuery::kAny, {}, 0.0, kNoHit}, message);
    if (is_own) {
      EXPECT_NO_THROW(relay.take(message));
    } else {
      EXPECT_THROW(relay.take(message), ProtocolError);
    }
    message.pop_back();
    EXPECT_THROW(relay.take(message), ProtocolError);
  }
  Bytes unknown;
  write_light(LightRay{0, 0, static_cast<LightQuery>(2), {}, 0.0, kNoHit}, unknown);
  EXPECT_THROW(read_light_rays(unknown), ProtocolError);
}

}  // namespace
}  // namespace beambench::cluster

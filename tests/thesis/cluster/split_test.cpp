// Properties of a divided scene: its parts contain the whole scene, and together its processes find
// the hits of a single process.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <numeric>
#include <random>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "harness/rays/fingerprint.hpp"
#include "harness/thesis/cluster/image_worker.hpp"
#include "harness/thesis/cluster/split/cell_costs.hpp"
#include "harness/thesis/cluster/split/part_member.hpp"
#include "harness/thesis/cluster/split/scene_division.hpp"
#include "harness/thesis/cluster/split/scene_split.hpp"
#include "harness/thesis/cluster/split/split_run.hpp"
#include "scenes/base/error.hpp"
#include "scenes/catalogue.hpp"
#include "tests/random_scene.hpp"
#include "tests/thesis/cluster/beam_options.hpp"
#include "tests/thesis/cluster/followers.hpp"
#include "tests/thesis/cluster/local_network.hpp"
#include "tests/thesis/cluster/scene_divisions.hpp"

namespace beambench::cluster {
namespace {

using tests::kSceneDivisions;
using tests::options_with;
using tests::random_scene;

SceneSplit split_of(const scenes::Scene& scene, int max_level, int level, SceneDivision division,
                    int processes) {
  const accel::PrimaryRays rays(scene.cameras.front(), 64, 64, 1);
  return split_scene(scene, options_with(max_level).octree, rays, level, division, processes);
}

TEST(SceneDivision, HasDistinctNames) {
  ASSERT_EQ(division_names().size(), kSceneDivisions.size());
  for (const SceneDivision division : kSceneDivisions) {
    EXPECT_EQ(parse_scene_division(division_names()[static_cast<std::size_t>(division)]), division);
  }
  EXPECT_THROW(parse_scene_division("halves"), InputError);
}

TEST(SceneSplit, AssignsEveryCellToOneProcessAndWorkToEach) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=4");
  for (const SceneDivision division : kSceneDivisions) {
    for (const int processes : {1, 2, 3, 7}) {
      const SceneSplit split = split_of(scene, 6, 4, division, processes);
      ASSERT_EQ(split.cells().count(), 512U);
      std::map<ProcessId, int> cells;
      for (std::uint32_t i = 0; i < split.cells().count(); ++i) {
        EXPECT_EQ(split.cells().index(split.cells().cell(i)), i);
        ++cells[split.owner(i)];
      }
      EXPECT_EQ(cells.size(), static_cast<std::size_t>(processes));
      EXPECT_EQ(cells.begin()->first, 0);
      EXPECT_EQ(cells.rbegin()->first, processes - 1);
    }
  }
}

TEST(SceneSplit, IsBalancedByPrimitives) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=4");
  for (const int processes : {2, 3, 7}) {
    const SceneSplit split = split_of(scene, 6, 4, SceneDivision::kPrimitives, processes);
    std::vector<std::size_t> sizes;
    for (ProcessId process = 0; process < processes; ++process) {
      sizes.push_back(part_of(scene, split, process).global.size());
    }
    const auto [least, most] = std::ranges::minmax(sizes);
    EXPECT_LT(most, 3 * least + 20) << processes;
  }
}

TEST(SceneDivision, AssignsAtMostTheShareAndOneCell) {
  const LevelCells cells(4);
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    CellLoads loads{std::vector<std::uint32_t>(512), std::vector<double>(512)};
    for (std::size_t i = 0; i < 512; ++i) {
      loads.primitives[i] = static_cast<std::uint32_t>(1 + random() % 3);
      loads.costs[i] = static_cast<double>(random() % 1000);
    }
    const double total = std::accumulate(loads.costs.begin(), loads.costs.end(), 0.0);
    for (const SceneDivision division : {SceneDivision::kCost, SceneDivision::kScattered}) {
      const auto owners = divide(cells, loads, division, 8);
      std::vector<double> sums(8);
      std::vector<double> primitives(8);
      for (std::size_t i = 0; i < 512; ++i) {
        sums[owners[i]] += loads.costs[i];
        primitives[owners[i]] += loads.primitives[i];
      }
      EXPECT_LT(std::ranges::max(sums), total / 8 + 1000.0);
      EXPECT_GT(std::ranges::min(sums), total / 8 - 1000.0);
      if (division == SceneDivision::kScattered) {
        const double all = std::accumulate(primitives.begin(), primitives.end(), 0.0);
        EXPECT_LT(std::ranges::max(primitives), 1.05 * all / 8 + 3.0);
      }
    }
  }
}

TEST(SceneDivision, BisectsIntoBoxesOfCells) {
  const LevelCells cells(4);
  CellLoads loads{std::vector<std::uint32_t>(512, 1), std::vector<double>(512, 1.0)};
  loads.costs[0] = 300.0;
  for (const int processes : {1, 2, 5, 8}) {
    const auto owners = divide(cells, loads, SceneDivision::kBisection, processes);
    for (int process = 0; process < processes; ++process) {
      glm::ivec3 lower(8);
      glm::ivec3 upper(-1);
      int count = 0;
      for (std::uint32_t i = 0; i < 512; ++i) {
        if (owners[i] != process) continue;
        lower = glm::min(lower, cells.cell(i));
        upper = glm::max(upper, cells.cell(i));
        ++count;
      }
      ASSERT_GT(count, 0);
      const glm::ivec3 size = upper - lower + 1;
      EXPECT_EQ(count, size.x * size.y * size.z);
    }
  }
}

TEST(SceneDivision, AssignsCellsWithPrimitivesInTurn) {
  const LevelCells cells(3);
  CellLoads loads{std::vector<std::uint32_t>(64), {}};
  for (const std::uint32_t i : {1U, 5U, 17U, 20U, 33U, 60U, 63U}) loads.primitives[i] = 9;
  const auto owners = divide(cells, loads, SceneDivision::kInterleaved, 3);
  std::array<int, 3> full{};
  for (std::uint32_t i = 0; i < 64; ++i) full[owners[i]] += loads.primitives[i] > 0 ? 1 : 0;
  EXPECT_EQ(full, (std::array{3, 2, 2}));
}

TEST(SampledCosts, AreWhereTheRaysAre) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=4");
  const SceneCells contents(scene, options_with(6).octree, 4);
  const auto costs = [&](int width, int height) {
    const accel::PrimaryRays rays(scene.cameras.front(), width, height, 1);
    return sampled_costs(scene, options_with(6).octree, rays, contents);
  };
  const std::vector<double> found = costs(200, 200);
  EXPECT_EQ(found, costs(200, 200));
  EXPECT_GT(std::ranges::max(found), 0.0);
  for (std::uint32_t i = 0; i < found.size(); ++i) {
    EXPECT_GE(found[i], 0.0);
    if (contents.is_empty(i)) {
      EXPECT_EQ(found[i], 0.0);
    }
  }
  // The sample has the same number of rays, but each represents four times as many image rays.
  const std::vector<double> finer = costs(400, 400);
  EXPECT_GT(std::accumulate(finer.begin(), finer.end(), 0.0),
            std::accumulate(found.begin(), found.end(), 0.0));
}

TEST(ScenePart, IsTheSameGeometryUnderLocalIds) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const scenes::Scene scene = verify::random_scene(seed, 60);
    const SceneSplit split = split_of(scene, 5, 3, SceneDivision::kInterleaved, 3);
    std::set<scenes::PrimitiveId> all;
    for (ProcessId process = 0; process < 3; ++process) {
      const ScenePart part = part_of(scene, split, process);
      ASSERT_EQ(part.global.size(), part.scene.primitives.size());
      EXPECT_TRUE(std::ranges::is_sorted(part.global));
      for (scenes::PrimitiveId id = 0; id < part.global.size(); ++id) {
        all.insert(part.global[id]);
        const scenes::Bounds here = scenes::primitive_bounds(part.scene, id);
        const scenes::Bounds there = scenes::primitive_bounds(scene, part.global[id]);
        EXPECT_EQ(here.lower, there.lower);
        EXPECT_EQ(here.upper, there.upper);
        EXPECT_EQ(part.scene.primitives[id].surface, scene.primitives[part.global[id]].surface);
      }
      EXPECT_EQ(part.scene.bounds.lower, scene.bounds.lower);
    }
    EXPECT_EQ(all.size(), scene.primitives.size());
  }
}

/// Traces an image with several processes, which run as threads.
accel::HitBuffer traced_in_parts(const scenes::Scene& scene,
                                 const accel::beam::BeamOptions& options,
                                 const accel::PrimaryRays& rays, int level, int processes,
                                 unsigned seed, SceneDivision division = SceneDivision::kPrimitives,
                                 std::vector<PartReport>* reports = nullptr) {
  LocalNetwork network(processes, seed, 0.0003);
  const SceneSplit split = split_scene(scene, options.octree, rays, level, division, processes);
  accel::HitBuffer hits(rays.width(), rays.height(), rays.samples());
  std::mutex mutex;
  const auto trace = [&](ProcessId self) {
    Outbox outbox(network.at(self), split);
    PartWorker worker(part_of(scene, split, self), split, self, options, rays, outbox);
    PartMember member(network.at(self), worker, outbox, 20.0,
                      [](ProcessId, std::span<const std::byte>) {});
    if (self == kProducer) {
      member.lead();
    } else {
      network.at(self).send(kProducer, Tag::kReady, {});
      member.follow([] { return Bytes{}; });
    }
    const std::lock_guard lock(mutex);
    for (const std::uint32_t sample : worker.hit_samples()) {
      EXPECT_FALSE(hits.get(sample)) << "found twice";
      hits.set(sample, worker.hits().get(sample));
    }
    if (reports != nullptr) reports->push_back(member.report());
  };
  std::vector<std::jthread> others;
  for (ProcessId process = 1; process < processes; ++process) others.emplace_back(trace, process);
  trace(kProducer);
  others.clear();  // joins
  return hits;
}

TEST(SplitScene, FindsTheHitsOfOneProcessBitForBit) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    const scenes::Scene scene = verify::random_scene(seed, 60);
    const accel::beam::BeamOptions options = options_with(5, seed % 3 == 0 ? 50 : 0);
    const accel::PrimaryRays rays(scene.cameras.front(), 61, 43, seed % 2 == 0 ? 1 : 5);
    accel::HitBuffer expected(rays.width(), rays.height(), rays.samples());
    accel::beam::BeamTracer(scene, options).closest_hits(rays, expected, {});
    for (const int processes : {1, 2, 5}) {
      const int level = 2 + static_cast<int>(seed) % 4;
      for (const SceneDivision division : kSceneDivisions) {
        EXPECT_TRUE(traced_in_parts(scene, options, rays, level, processes, seed, division) ==
                    expected)
            << "seed " << seed << ", level " << level << ", " << processes << " processes, "
            << division_names()[static_cast<std::size_t>(division)];
      }
    }
  }
}

TEST(SplitScene, FindsTheSameHitsFromInside) {
  const scenes::Scene scene = verify::random_scene(1, 40);
  const auto size = glm::vec3(scene.bounds.upper - scene.bounds.lower);
  const auto middle = scene.bounds.lower + 0.5F * size;
  for (const glm::vec3 place :
       {middle, middle + 0.1F * size, middle - glm::vec3(0.2F, 0.0F, 0.3F) * size}) {
    scenes::Camera camera;
    camera.from = place;
    camera.at = place + glm::vec3(1.0F, 0.3F, -0.2F);
    camera.angle = 100.0F;
    const accel::PrimaryRays rays(camera, 60, 60, 1);
    accel::HitBuffer expected(60, 60, 1);
    accel::beam::BeamTracer(scene, options_with(5)).closest_hits(rays, expected, {});
    for (const SceneDivision division : kSceneDivisions) {
      EXPECT_TRUE(traced_in_parts(scene, options_with(5), rays, 3, 4, 1, division) == expected);
    }
  }
}

TEST(SplitScene, AccountsForAllCrossings) {
  const scenes::Scene scene = verify::random_scene(2, 200);
  const accel::PrimaryRays rays(scene.cameras.front(), 80, 60, 1);
  std::vector<PartReport> reports;
  traced_in_parts(scene, options_with(6), rays, 3, 3, 1, SceneDivision::kPrimitives, &reports);
  Traffic out;
  Traffic in;
  std::uint64_t travelers = 0;
  for (const PartReport& report : reports) {
    out.messages += report.crossings_out.messages;
    out.bytes += report.crossings_out.bytes;
    in.messages += report.crossings_in.messages;
    in.bytes += report.crossings_in.bytes;
    travelers += report.beams_out + report.rays_out;
    EXPECT_LT(report.primitives, scene.primitives.size());
    EXPECT_GT(report.structure_bytes, 0U);
  }
  EXPECT_GT(travelers, 0U);
  EXPECT_EQ(out.messages, in.messages);
  EXPECT_EQ(out.bytes, in.bytes);
  EXPECT_GE(out.bytes, 25 * travelers);
}

TEST(SplitScene, RunsFromACommandLineToItsEnd) {
  const scenes::Scene scene = scenes::load_scene("tetra:n=3");
  accel::HitBuffer expected(40, 30, 1);
  accel::beam::BeamTracer(scene, options_with(6))
      .closest_hits(accel::PrimaryRays(scene.cameras.front(), 40, 30, 1), expected, {});
  ClusterRequest request;
  request.job.scene = "tetra:n=3";
  request.job.structure = "beam:max_level=6";
  request.job.resolution = {40, 30};
  request.job.split_level = 3;
  LocalNetwork network(3, 1, 0.0);
  EXPECT_EQ(led(lead_split, request, network).result_hash, rays::fingerprint(expected));
}

TEST(SplitScene, EndsWithAnErrorIfAProcessIsSilent) {
  const scenes::Scene scene = verify::random_scene(2, 60);
  const accel::beam::BeamOptions options = options_with(5);
  const accel::PrimaryRays rays(scene.cameras.front(), 60, 60, 1);
  const SceneSplit split = split_of(scene, 5, 3, SceneDivision::kPrimitives, 2);
  LocalNetwork network(2, 1, 0.0);
  network.mute_after(1, 1);  // it reports that it is ready
  std::jthread other([&] {
    Outbox outbox(network.at(1), split);
    PartWorker worker(part_of(scene, split, 1), split, 1, options, rays, outbox);
    network.at(1).send(kProducer, Tag::kReady, {});
    PartMember(network.at(1), worker, outbox, 0.2, [](ProcessId, std::span<const std::byte>) {
    }).follow([] { return Bytes{}; });
  });
  Outbox outbox(network.at(0), split);
  PartWorker worker(part_of(scene, split, 0), split, 0, options, rays, outbox);
  PartMember member(network.at(0), worker, outbox, 0.2,
                    [](ProcessId, std::span<const std::byte>) {});
  EXPECT_THROW(member.lead(), LostProcess);
}

TEST(SplitScene, RefusesOptionsThatNeedTheWholeImage) {
  const scenes::Scene scene = verify::random_scene(2, 10);
  const accel::PrimaryRays rays(scene.cameras.front(), 10, 10, 5);
  LocalNetwork network(1, 1, 0.0);
  accel::beam::BeamOptions options = options_with(3);
  const SceneSplit split = split_of(scene, 4, 4, SceneDivision::kPrimitives, 1);
  Outbox outbox(network.at(0), split);
  const auto make = [&] {
    const PartWorker worker(part_of(scene, split, 0), split, 0, options, rays, outbox);
  };
  EXPECT_THROW(make(), InputError);  // cells deeper than the octree
  options = options_with(5);
  options.continue_with_rays = false;
  EXPECT_THROW(make(), InputError);
  options = options_with(5);
  options.share_corners = true;
  EXPECT_THROW(make(), InputError);
}

}  // namespace
}  // namespace beambench::cluster

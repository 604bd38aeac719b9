// An image or a list on several threads: the hits and counts do not depend on which thread found
// them.

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include "accel/core/float_mode.hpp"
#include "accel/core/registry.hpp"
#include "accel/core/threads.hpp"
#include "accel/core/traversal_accelerator.hpp"
#include "scenes/base/cpu_quota.hpp"
#include "scenes/catalogue.hpp"
#include "tests/random_scene.hpp"

namespace beambench::accel {
namespace {

constexpr int kThreads[] = {1, 2, 3, 8};

/// Returns all counters except times, which always differ.
std::map<std::string, std::uint64_t, std::less<>> counts(const WorkCounters& counters) {
  auto all = counters.by_name();
  std::erase_if(all, [](const auto& counter) { return counter.first.ends_with("_ns"); });
  return all;
}

/// Expects the same hits and counts from `trace` with any number of threads.
void expect_same_on_threads(const StructureChoice& choice, const scenes::Scene& scene,
                            const PrimaryRays& rays) {
  SCOPED_TRACE(choice.label() + " over " + scene.name);
  if (!choice.info().support.includes(scene)) return;
  const auto structure = choice.build(scene);
  HitBuffer expected(rays.width(), rays.height(), rays.samples());
  WorkCounters expected_counters;
  structure->closest_hits(rays, expected, {&expected_counters});
  for (const int threads : kThreads) {
    HitBuffer hits(rays.width(), rays.height(), rays.samples());
    HitBuffer counted(rays.width(), rays.height(), rays.samples());
    WorkCounters counters;
    structure->closest_hits(rays, hits, {.threads = threads});
    structure->closest_hits(rays, counted, {&counters, threads});
    EXPECT_EQ(hits, expected) << threads << " threads";
    EXPECT_EQ(counted, expected) << threads << " threads, counting";
    EXPECT_EQ(counts(counters), counts(expected_counters)) << threads << " threads";
  }
}

/// Expects the same for a list that is longer than a thread's share.
void expect_same_list_on_threads(const StructureChoice& choice, const scenes::Scene& scene) {
  SCOPED_TRACE(choice.label() + " over " + scene.name);
  if (!choice.info().support.batches) return;
  // While it exists, Embree limits TBB to the threads of its workload.
  const auto structure = choice.build(scene, {scene.cameras.front(), 10'000, 8});
  Random random(17);
  const std::vector<Ray> rays = verify::random_rays(scene, 10'000, random);
  const auto trace = [&](int threads) {
    HitBuffer hits(static_cast<int>(rays.size()), 1, 1);
    HitBuffer counted(static_cast<int>(rays.size()), 1, 1);
    std::vector<std::uint8_t> any(rays.size());
    WorkCounters counters;
    structure->closest_hits(RayBatch{rays}, hits, {.threads = threads});
    structure->closest_hits(RayBatch{rays}, counted, {&counters, threads});
    structure->any_hits(RayBatch{rays}, any, {&counters, threads});
    EXPECT_EQ(counted, hits);
    return std::tuple(hits, any, counts(counters));
  };
  const auto alone = trace(1);
  for (const int threads : kThreads) EXPECT_EQ(trace(threads), alone) << threads << " threads";
}

std::vector<std::string> all_names() {
  std::vector<std::string> names;
  for (const auto& info : registry().structures()) names.push_back(info.name);
  return names;
}

class Threads : public ::testing::TestWithParam<std::string> {};

TEST_P(Threads, ChangeNoHitAndNoCount) {
  for (const char* name : {"escena1", "escena2", "bumpy:triangles=768"}) {
    const scenes::Scene scene = scenes::load_scene(name);
    for (const int samples : {1, 5}) {
      const PrimaryRays rays(scene.cameras.front(), 61, 47, samples);
      expect_same_on_threads(registry().choose({GetParam(), {}}), scene, rays);
    }
  }
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const scenes::Scene scene = tests::random_scene(seed, 40);
    const PrimaryRays rays(scene.cameras.front(), 40, 33, 1);
    expect_same_on_threads(registry().choose({GetParam(), {}}), scene, rays);
  }
}

std::string name_of_case(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

TEST_P(Threads, ChangeNoHitAndNoCountOfLists) {
  for (const char* name : {"escena1", "bumpy:triangles=768"}) {
    expect_same_list_on_threads(registry().choose({GetParam(), {}}), scenes::load_scene(name));
  }
}

INSTANTIATE_TEST_SUITE_P(All, Threads, ::testing::ValuesIn(all_names()), name_of_case);

// Cases in which threads share more than the buffer: beams that continue behind leaves, corners of
// several pixels, packets across the borders of threads' shares, lists that are filled on first
// use.
TEST(ThreadsOf, EveryModeChangesNoHitAndNoCount) {
  for (const char* spec :
       {"beam:continue=beams", "beam:handover=48", "beam:share_corners=true,continue=beams",
        "beam:max_level=8", "beam:max_level=1", "embree:mode=packet4", "embree:mode=packet16",
        "voxel-grid:fill=lazy", "tile-beam:parallel=true"}) {
    const StructureChoice choice = registry().choose(parse_spec(spec));
    const scenes::Scene scene = scenes::load_scene("escena1");
    const PrimaryRays rays(scene.cameras.front(), 80, 60, 5);
    expect_same_on_threads(choice, scene, rays);
  }
}

/// Records which threads called it and their floating-point mode. Each thread waits until the
/// expected number of threads has arrived.
class Meeting : public TraversalAccelerator<Meeting> {
 public:
  explicit Meeting(std::size_t expected) : expected_(expected) {}
  Statistics statistics() const override { return {}; }

  template <class Counting>
  std::optional<Hit> find_closest(const Ray&, Counting&) const {
    std::unique_lock lock(mutex_);
    threads_.insert(std::this_thread::get_id());
    modes_.insert(float_mode() & kFlushSubnormals);
    came_.notify_all();
    came_.wait_for(lock, std::chrono::seconds(20), [&] { return threads_.size() >= expected_; });
    return std::nullopt;
  }
  template <class Counting>
  bool find_any(const Ray&, Counting&) const {
    return false;
  }

  std::size_t threads() const { return threads_.size(); }
  const std::set<unsigned>& modes() const { return modes_; }

 private:
  std::size_t expected_;
  mutable std::mutex mutex_;
  mutable std::condition_variable came_;
  mutable std::set<std::thread::id> threads_;
  mutable std::set<unsigned> modes_;
};

TEST(TraceOn, UsesAsManyThreadsAsRequested) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  const PrimaryRays rays(scene.cameras.front(), 1, 64, 1);
  HitBuffer buffer(1, 64, 1);
  for (const int threads : kThreads) {
    const Meeting meeting(static_cast<std::size_t>(threads));
    meeting.closest_hits(rays, buffer, {.threads = threads});
    EXPECT_EQ(meeting.threads(), static_cast<std::size_t>(threads));
  }
  EXPECT_EQ(thread_count(3), 3);
  EXPECT_GE(thread_count(0), 1);
}

TEST(TraceOn, DefaultThreadsAreThoseThatTheQuotaKeepsBusy) {
  EXPECT_EQ(thread_count(0), threads_within(tbb::info::default_concurrency(), cpu_quota()));
  int allowed = 0;
  on_default_threads([&] { allowed = tbb::this_task_arena::max_concurrency(); });
  EXPECT_EQ(allowed, thread_count(0));
  on_threads(3, [&] { allowed = tbb::this_task_arena::max_concurrency(); });
  EXPECT_EQ(allowed, 3);
}

// Embree limits TBB to the threads of its devices, which would also limit other structures.
TEST(TraceOn, EmbreeAllowsTheThreadsOfItsWorkload) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  Workload workload = usual_workload(scene);
  workload.threads = 2;
  const auto embree = registry().choose({"embree", {}}).build(scene, workload);
  EXPECT_GE(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism),
            static_cast<std::size_t>(std::min(2, tbb::info::default_concurrency())));
}

TEST(TraceOn, ThreadsComputeInTheCallersMode) {
  const scenes::Scene scene = scenes::load_scene("escena1");
  const PrimaryRays rays(scene.cameras.front(), 1, 64, 1);
  HitBuffer buffer(1, 64, 1);
  const unsigned before = float_mode();
  for (const unsigned mode : {0U, kFlushSubnormals, 0U}) {
    const Meeting meeting(3);
    set_float_mode((before & ~kFlushSubnormals) | mode);
    meeting.closest_hits(rays, buffer, {.threads = 3});
    set_float_mode(before);
    EXPECT_EQ(meeting.modes(), std::set<unsigned>{mode});
  }
}

}  // namespace
}  // namespace beambench::accel

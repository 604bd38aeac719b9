// The conditions that timed code runs under.

#include <limits>

#include <gtest/gtest.h>
#include <sched.h>

#include "harness/measure/measurement.hpp"

namespace beambench::measure {
namespace {

/// Returns half the smallest normal float: a subnormal number, or zero if those are flushed.
float half_of_the_smallest() {
  volatile float smallest = std::numeric_limits<float>::min();
  return smallest * 0.5F;
}

TEST(MeasuringFloatMode, FlushesSubnormalsAndIsRestored) {
  if (!MeasuringFloatMode::available()) GTEST_SKIP() << "its control word is not known";
  EXPECT_GT(half_of_the_smallest(), 0.0F);
  {
    const MeasuringFloatMode mode;
    EXPECT_EQ(half_of_the_smallest(), 0.0F);
  }
  EXPECT_GT(half_of_the_smallest(), 0.0F);
}

TEST(PinnedThread, StaysOnItsCoreAndIsFreedAgain) {
  cpu_set_t before;
  ASSERT_EQ(::sched_getaffinity(0, sizeof(before), &before), 0);
  {
    const PinnedThread pin(present_core());
    if (!pin.pinned()) GTEST_SKIP() << "this system does not allow pinning";
    cpu_set_t now;
    ASSERT_EQ(::sched_getaffinity(0, sizeof(now), &now), 0);
    EXPECT_EQ(CPU_COUNT(&now), 1);
    EXPECT_TRUE(CPU_ISSET(static_cast<std::size_t>(present_core()), &now));
  }
  cpu_set_t after;
  ASSERT_EQ(::sched_getaffinity(0, sizeof(after), &after), 0);
  EXPECT_TRUE(CPU_EQUAL(&before, &after));
}

TEST(PinnedThread, WithoutACoreDoesNothing) { EXPECT_FALSE(PinnedThread(-1).pinned()); }

TEST(PhaseTimer, DistinguishesWorkFromWaiting) {
  const PhaseTime busy = time_phase([] { warm_up(std::chrono::milliseconds(20)); });
  EXPECT_GE(busy.wall_ms, 20.0);
  EXPECT_GT(busy.cpu_ms, 1.0);
  const timespec nap{0, 20'000'000};
  const PhaseTime waiting = time_phase([&] { ::nanosleep(&nap, nullptr); });
  EXPECT_GE(waiting.wall_ms, 20.0);
  EXPECT_LT(waiting.cpu_ms, 10.0);
}

}  // namespace
}  // namespace beambench::measure

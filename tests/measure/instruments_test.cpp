// Hardware counters, the heap and the noise.

#include <array>
#include <cerrno>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "harness/measure/measurement.hpp"
#include "tests/scenes/thrown_message.hpp"

namespace beambench::measure {
namespace {

/// Returns a file descriptor from which these numbers, 8 bytes each, are read as from a counter.
int counter_that_tells(const std::vector<std::uint64_t>& numbers) {
  std::array<int, 2> ends{};
  EXPECT_EQ(::pipe(ends.data()), 0);
  const std::size_t size = numbers.size() * sizeof(numbers[0]);
  EXPECT_EQ(::write(ends[1], numbers.data(), size), static_cast<ssize_t>(size));
  ::close(ends[1]);
  return ends[0];
}

int refused(int error) {
  errno = error;
  return -1;
}

TEST(HardwareCounters, ReportWhatWasCountedDuringTheWork) {
  const HardwareCounters counters([](const perf_event_attr& attributes) {
    EXPECT_EQ(attributes.exclude_kernel, 1U);
    switch (attributes.config) {
      case PERF_COUNT_HW_INSTRUCTIONS:
        return counter_that_tells({100, 10, 10, 350, 20, 20});
      case PERF_COUNT_HW_CPU_CYCLES:
        return counter_that_tells({0, 0, 0, 100, 40, 10});
      default:
        return counter_that_tells({7, 10, 10, 7, 20, 10});
    }
  });
  EXPECT_EQ(counters.problem(), "");
  bool worked = false;
  const HardwareCounts counts = counters.count([&] { worked = true; });
  EXPECT_TRUE(worked);
  EXPECT_EQ(counts[0], 250U);
  EXPECT_EQ(counts[1], 400U) << "the counter ran a quarter of the time";
  EXPECT_EQ(counts[2], std::nullopt) << "the counter never ran";
}

TEST(HardwareCounters, WithoutThemTheWorkIsStillDone) {
  const HardwareCounters counters([](const perf_event_attr&) { return refused(ENOENT); });
  EXPECT_TRUE(scenes::says(counters.problem(), {"instructions", "no such counter"}));
  bool worked = false;
  const HardwareCounts counts = counters.count([&] { worked = true; });
  EXPECT_TRUE(worked);
  for (const auto& count : counts) EXPECT_FALSE(count);
}

TEST(HardwareCounters, AForbiddenOneDoesNotAffectTheOthers) {
  const HardwareCounters counters([](const perf_event_attr& attributes) {
    return attributes.config == PERF_COUNT_HW_CACHE_MISSES ? refused(EACCES)
                                                           : counter_that_tells({1, 1, 1, 3, 2, 2});
  });
  EXPECT_TRUE(scenes::says(counters.problem(), {"cache_misses", "perf_event_paranoid"}));
  const HardwareCounts counts = counters.count([] {});
  EXPECT_EQ(counts[0], 2U);
  EXPECT_EQ(counts[2], std::nullopt);
}

TEST(HardwareCounters, OfThisMachineCountOrExplainWhyNot) {
  const HardwareCounters counters;
  const HardwareCounts counts = counters.count([] { warm_up(std::chrono::milliseconds(2)); });
  if (!counters.problem().empty()) GTEST_SKIP() << counters.problem();
  EXPECT_GT(counts[0], 1000U);
}

TEST(Heap, GrowsByTheAllocatedAmount) {
  const auto before = heap_in_use();
  if (!before) GTEST_SKIP() << "this allocator does not report its bytes";
  for (const std::size_t size : {std::size_t{20'000}, std::size_t{8'000'000}}) {
    const auto empty = heap_in_use();
    const std::vector<char> block(size, 'x');
    const auto growth = heap_growth(empty, heap_in_use());
    ASSERT_TRUE(growth);
    EXPECT_GE(*growth, size);
    EXPECT_LE(*growth, size + 8192);
  }
  EXPECT_EQ(heap_growth(100, 40), 0U);
  EXPECT_EQ(heap_growth(std::nullopt, 40), std::nullopt);
}

TEST(Noise, IsTheExcessOfTheSlowestTwentieth) {
  std::vector<double> slices(100, 2.0);
  EXPECT_EQ(noise(slices), 0.0);
  for (std::size_t i = 0; i < 3; ++i) slices[10 * i] = 50.0;
  EXPECT_EQ(noise(slices), 0.0) << "3 of 100 are less than a twentieth";
  for (std::size_t i = 0; i < 8; ++i) slices[10 * i] = 3.0;
  EXPECT_EQ(noise(slices), 0.5);
  slices.resize(39);
  EXPECT_EQ(noise(slices), std::nullopt);
}

}  // namespace
}  // namespace beambench::measure

// Limits of control groups, as the kernel lays them out: both versions, nested groups, containers.

#include "scenes/base/control_groups.hpp"

#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "scenes/base/cpu_quota.hpp"
#include "scenes/base/process_memory.hpp"
#include "tests/fake_system.hpp"

namespace beambench {
namespace {

/// Returns a mount of version 1 in /proc/self/mountinfo.
std::string mount_of(const std::string& controllers, const std::string& mounted,
                     const std::string& point) {
  return "32 31 0:29 " + mounted + " " + point + " rw,relatime - cgroup cgroup rw," + controllers +
         "\n";
}

TEST(CpuQuota, IsAbsentWithoutControlGroups) {
  const FakeSystem system;
  EXPECT_EQ(cpu_quota(system.root()), std::nullopt);
  EXPECT_TRUE(read_throttling(system.root()).empty());
  EXPECT_EQ(available_memory(system.root()), std::nullopt);
  EXPECT_EQ(threads_within(8, cpu_quota(system.root())), 8);
}

TEST(CpuQuota, IsAbsentInAGroupWithoutOne) {
  const FakeSystem system;
  system.join_group("/a");
  EXPECT_EQ(cpu_quota(system.root()), std::nullopt);
  system.write("sys/fs/cgroup/a/cpu.max", "max 100000\n");
  EXPECT_EQ(cpu_quota(system.root()), std::nullopt);
  system.count_throttling("/a", 0, 0);
  EXPECT_EQ(throttling_between({}, read_throttling(system.root())), std::nullopt);
}

TEST(CpuQuota, OfVersion2IsTheMinimumOfTheGroupAndItsAncestors) {
  const FakeSystem system;
  system.join_group("/a/b");
  system.write("sys/fs/cgroup/a/b/cpu.max", "150000 100000\n");
  EXPECT_EQ(cpu_quota(system.root()), 1.5);
  system.write("sys/fs/cgroup/a/cpu.max", "20000 100000\n");
  EXPECT_EQ(cpu_quota(system.root()), 0.2);
  system.write("sys/fs/cgroup/other/cpu.max", "1000 100000\n");
  EXPECT_EQ(cpu_quota(system.root()), 0.2);
}

TEST(CpuQuota, OfVersion1IsFoundByItsController) {
  const FakeSystem system;
  system.write("proc/self/cgroup", "5:cpuset:/else\n4:cpu,cpuacct:/a/b\n1:name=systemd:/\n0::/\n");
  system.write("proc/self/mountinfo", mount_of("cpuset", "/", "/sys/fs/cgroup/cpuset") +
                                          mount_of("cpu,cpuacct", "/", "/sys/fs/cgroup/cpu"));
  system.write("sys/fs/cgroup/cpu/a/cpu.cfs_quota_us", "50000\n");
  system.write("sys/fs/cgroup/cpu/a/cpu.cfs_period_us", "20000\n");
  system.write("sys/fs/cgroup/cpu/a/b/cpu.cfs_quota_us", "-1\n");
  system.write("sys/fs/cgroup/cpu/a/b/cpu.cfs_period_us", "100000\n");
  system.write("sys/fs/cgroup/cpuset/else/cpu.cfs_quota_us", "1000\n");
  system.write("sys/fs/cgroup/cpuset/else/cpu.cfs_period_us", "20000\n");
  EXPECT_EQ(cpu_quota(system.root()), 2.5);
}

TEST(CpuQuota, OfAHybridSystemIsFoundInTheVersionThatHasTheController) {
  const FakeSystem system;
  system.write("proc/self/cgroup", "4:cpu:/a\n0::/a\n");
  system.write("proc/self/mountinfo",
               mount_of("cpu", "/", "/sys/fs/cgroup/cpu") +
                   "41 31 0:38 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n");
  system.write("sys/fs/cgroup/unified/a/cgroup.procs", "1\n");
  system.write("sys/fs/cgroup/cpu/a/cpu.cfs_quota_us", "70000\n");
  system.write("sys/fs/cgroup/cpu/a/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(cpu_quota(system.root()), 0.7);
}

TEST(CpuQuota, OfAContainerIsThatOfItsMountedGroup) {
  for (const char* group : {"/docker/x", "/", "/../../x", "/docker/elsewhere"}) {
    const FakeSystem system;
    system.write("proc/self/cgroup", std::string("4:cpu:") + group + "\n");
    system.write("proc/self/mountinfo", mount_of("cpu", "/docker/x", "/sys/fs/cgroup/cpu"));
    system.write("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "30000\n");
    system.write("sys/fs/cgroup/cpu/cpu.cfs_period_us", "10000\n");
    EXPECT_EQ(cpu_quota(system.root()), 3.0) << group;
  }
}

TEST(CpuQuota, IsFoundBelowAnyMountPoint) {
  const FakeSystem system;
  system.write("proc/self/cgroup", "0::/a:b\n");
  system.write("proc/self/mountinfo", "31 25 0:26 / /my\\040groups rw - cgroup2 none rw\n");
  system.write("my groups/a:b/cpu.max", "50000 100000\n");
  EXPECT_EQ(cpu_quota(system.root()), 0.5);
}

TEST(CpuQuota, DeterminesTheThreadsButAtLeastOne) {
  EXPECT_EQ(threads_within(8, std::nullopt), 8);
  EXPECT_EQ(threads_within(8, 0.2), 1);
  EXPECT_EQ(threads_within(8, 2.0), 2);
  EXPECT_EQ(threads_within(8, 2.1), 3);
  EXPECT_EQ(threads_within(8, 64.0), 8);
  EXPECT_EQ(threads_within(8, 1e12), 8);
  EXPECT_EQ(threads_within(0, 0.0), 1);
}

TEST(Throttling, IsTheGrowthOfTheGroupThatWaitedMost) {
  const FakeSystem system;
  system.join_group("/a/b");
  system.count_throttling("/a", 100, 90);
  system.count_throttling("/a/b", 10, 1);
  const ThrottlingByGroup before = read_throttling(system.root());
  ASSERT_EQ(before.size(), 2U);
  EXPECT_EQ(throttling_between(before, before), std::nullopt);
  system.count_throttling("/a", 130, 91);
  system.count_throttling("/a/b", 24, 13);
  const auto grown = throttling_between(before, read_throttling(system.root()));
  ASSERT_TRUE(grown);
  EXPECT_EQ(grown->periods, 14U);
  EXPECT_EQ(grown->throttled, 12U);
  EXPECT_DOUBLE_EQ(grown->seconds, 0.96);
}

TEST(Throttling, OfVersion1IsCountedInNanoseconds) {
  const FakeSystem system;
  system.write("proc/self/cgroup", "4:cpu:/\n");
  system.write("proc/self/mountinfo", mount_of("cpu", "/", "/sys/fs/cgroup/cpu"));
  system.write("sys/fs/cgroup/cpu/cpu.stat",
               "nr_periods 14\nnr_throttled 12\nthrottled_time 960000000\n");
  const auto grown = throttling_between({}, read_throttling(system.root()));
  ASSERT_TRUE(grown);
  EXPECT_EQ(grown->throttled, 12U);
  EXPECT_DOUBLE_EQ(grown->seconds, 0.96);
}

TEST(Throttling, OfTwoPartsIsSummed) {
  const Throttling first{10, 4, 0.5};
  EXPECT_EQ(added_up(std::nullopt, std::nullopt), std::nullopt);
  EXPECT_EQ(added_up(first, std::nullopt), first);
  EXPECT_EQ(added_up(std::nullopt, first), first);
  EXPECT_EQ(added_up(first, Throttling{5, 1, 0.25}), (Throttling{15, 5, 0.75}));
}

TEST(AvailableMemory, IsWhatTheGroupAndItsAncestorsLeave) {
  const FakeSystem system;
  system.join_group("/a/b");
  system.write("proc/meminfo", "MemTotal: 9000 kB\nMemAvailable: 8000 kB\n");
  EXPECT_EQ(available_memory(system.root()), 8000U * 1024);
  system.write("sys/fs/cgroup/a/memory.max", "5000000\n");
  system.write("sys/fs/cgroup/a/memory.current", "3000000\n");
  system.write("sys/fs/cgroup/a/memory.stat", "anon 1\ninactive_file 500000\n");
  system.write("sys/fs/cgroup/a/b/memory.max", "max\n");
  system.write("sys/fs/cgroup/a/b/memory.current", "2000000\n");
  EXPECT_EQ(available_memory(system.root()), 2500000U);
}

}  // namespace
}  // namespace beambench

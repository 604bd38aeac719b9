#pragma once
// The CPU time that control groups allow this process (CFS bandwidth control; see
// Documentation/scheduler/sched-bwc.rst of Linux).

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>

namespace beambench {

/// Returns how many processors' worth of time the process may use: the smallest ratio of quota to
/// period (usually 100 ms) of its control group and the groups above it. Returns nothing if time is
/// not limited. `root`: as for `control_groups`.
std::optional<double> cpu_quota(const std::filesystem::path& root = "/");

/// Returns how many threads to use by default on this many cores: at most the quota, rounded up,
/// and at least one.
int threads_within(int cores, const std::optional<double>& quota);

/// A control group's periods under a quota, and its waits for the next period.
struct Throttling {
  std::uint64_t periods = 0;    ///< periods in which the group ran
  std::uint64_t throttled = 0;  ///< periods in which the quota was used up
  double seconds = 0.0;         ///< waiting time of all processors together

  bool operator==(const Throttling&) const = default;
};

/// Returns the combined throttling of two time spans, or nothing if no quota was in force in
/// either.
std::optional<Throttling> added_up(const std::optional<Throttling>& first,
                                   const std::optional<Throttling>& second);

/// The kernel's current counts for each control group of the process, keyed by the group's folder.
using ThrottlingByGroup = std::map<std::filesystem::path, Throttling>;

/// Reads the counts; the result is empty without control groups. `root`: as for `control_groups`.
ThrottlingByGroup read_throttling(const std::filesystem::path& root = "/");

/// Returns the growth of the counts in the most throttled group, or nothing if no group ran under a
/// quota in between.
std::optional<Throttling> throttling_between(const ThrottlingByGroup& before,
                                             const ThrottlingByGroup& after);

}  // namespace beambench

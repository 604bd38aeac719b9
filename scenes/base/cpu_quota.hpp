#pragma once
// The CPU time that control groups allow this process: CFS bandwidth control in Linux's
// Documentation/scheduler/sched-bwc.rst.

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>

namespace beambench {

/// Returns how many processors' time the process may use: the least quota of its control group and
/// those above it, over the period (usually 100 ms) in which it is granted. Nothing where time is
/// not limited. `root` as for `control_groups`.
std::optional<double> cpu_quota(const std::filesystem::path& root = "/");

/// Returns how many threads to use by default on so many cores: no more than the quota, rounded up,
/// keeps busy, and at least one.
int threads_within(int cores, const std::optional<double>& quota);

/// A control group's periods under a quota, and its waits for the next period.
struct Throttling {
  std::uint64_t periods = 0;    ///< in which the group ran
  std::uint64_t throttled = 0;  ///< of these, periods whose quota did not suffice
  double seconds = 0.0;         ///< waited, by all processors together

  bool operator==(const Throttling&) const = default;
};

/// Returns the throttling in two stretches of time together; nothing where no quota was in force in
/// either.
std::optional<Throttling> added_up(const std::optional<Throttling>& first,
                                   const std::optional<Throttling>& second);

/// The kernel's counts for each control group of the process so far, by the group's folder.
using ThrottlingByGroup = std::map<std::filesystem::path, Throttling>;

/// Reads the counts; there are none without control groups. `root` as for `control_groups`.
ThrottlingByGroup read_throttling(const std::filesystem::path& root = "/");

/// Returns the growth of the counts in the group that was throttled most. Nothing where no group
/// ran under a quota meanwhile.
std::optional<Throttling> throttling_between(const ThrottlingByGroup& before,
                                             const ThrottlingByGroup& after);

}  // namespace beambench

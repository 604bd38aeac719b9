#include "scenes/base/cpu_quota.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "scenes/base/control_groups.hpp"
#include "scenes/base/kernel_text.hpp"

namespace beambench {
namespace {

namespace fs = std::filesystem;

void take_least_ratio(std::optional<double>& least, std::optional<std::uint64_t> quota,
                      std::optional<std::uint64_t> period) {
  if (!quota || !period || *period == 0) return;  // `max` or -1: there is no quota
  const double ratio = static_cast<double>(*quota) / static_cast<double>(*period);
  least = std::min(least.value_or(ratio), ratio);
}

/// Adds the counts of a group's cpu.stat, in which the waiting time has a different name and unit
/// in each version.
void add_counts(ThrottlingByGroup& groups, const fs::path& folder, const char* time_name,
                double unit_seconds) {
  const std::string text = kernel_text(folder / "cpu.stat");
  const auto periods = value_of(text, "nr_periods ");
  const auto throttled = value_of(text, "nr_throttled ");
  if (!periods || !throttled) return;
  const auto time = static_cast<double>(value_of(text, time_name).value_or(0));
  groups[folder] = {*periods, *throttled, unit_seconds * time};
}

/// Returns the growth of a count. If the group was recreated in between, its counts started from 0
/// again.
template <class T>
T growth(T before, T after) {
  return after >= before ? after - before : after;
}

}  // namespace

std::optional<double> cpu_quota(const fs::path& root) {
  const ControlGroups groups = control_groups("cpu", root);
  std::optional<double> least;
  for (const fs::path& folder : groups.version2) {  // `20000 100000`
    const std::string text = kernel_text(folder / "cpu.max");
    const std::size_t blank = std::min(text.find(' '), text.size());
    take_least_ratio(least, number_at(text), number_at(std::string_view(text).substr(blank)));
  }
  for (const fs::path& folder : groups.version1) {
    take_least_ratio(least, number_at(kernel_text(folder / "cpu.cfs_quota_us")),
                     number_at(kernel_text(folder / "cpu.cfs_period_us")));
  }
  return least;
}

int threads_within(int cores, const std::optional<double>& quota) {
  const double busy = quota ? std::ceil(*quota) : static_cast<double>(cores);
  return static_cast<int>(std::max(std::min(busy, static_cast<double>(cores)), 1.0));
}

std::optional<Throttling> added_up(const std::optional<Throttling>& first,
                                   const std::optional<Throttling>& second) {
  if (!first || !second) return first ? first : second;
  return Throttling{first->periods + second->periods, first->throttled + second->throttled,
                    first->seconds + second->seconds};
}

ThrottlingByGroup read_throttling(const fs::path& root) {
  const ControlGroups groups = control_groups("cpu", root);
  ThrottlingByGroup counts;
  for (const fs::path& folder : groups.version2)
    add_counts(counts, folder, "throttled_usec ", 1e-6);
  for (const fs::path& folder : groups.version1)
    add_counts(counts, folder, "throttled_time ", 1e-9);
  return counts;
}

std::optional<Throttling> throttling_between(const ThrottlingByGroup& before,
                                             const ThrottlingByGroup& after) {
  std::optional<Throttling> most;
  for (const auto& [folder, now] : after) {
    const auto found = before.find(folder);
    const Throttling then = found == before.end() ? Throttling{} : found->second;
    const Throttling grown{growth(then.periods, now.periods), growth(then.throttled, now.throttled),
                           growth(then.seconds, now.seconds)};
    if (grown.periods == 0) continue;
    const auto rank = [](const Throttling& t) { return std::tuple(t.throttled, t.periods); };
    if (!most || rank(grown) > rank(*most)) most = grown;
  }
  return most;
}

}  // namespace beambench

#pragma once
// The conditions that disturb all times of a run, and how far its times can be trusted.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/base/cpu_quota.hpp"

namespace beambench::measure {

/// Noise above it, of the slowest twentieth of equal work, shows that others are running.
constexpr double kNoisy = 0.05;

/// Counts how the kernel throttles a run, from when it is made.
class ThrottlingWatch {
 public:
  /// `earlier` is the throttling of the parts before the run was resumed. `root` as for
  /// `cpu_quota`.
  ThrottlingWatch(std::filesystem::path root, std::optional<Throttling> earlier)
      : root_(std::move(root)), earlier_(earlier) {}

  /// Returns the throttling of the whole run up to now; nothing where no quota was in force.
  std::optional<Throttling> total() const {
    return added_up(earlier_, throttling_between(begin_, read_throttling(root_)));
  }

 private:
  std::filesystem::path root_;
  std::optional<Throttling> earlier_;
  ThrottlingByGroup begin_ = read_throttling(root_);
};

/// Returns the member `throttling` of a manifest; null where there is none.
nlohmann::ordered_json to_json(const std::optional<Throttling>& throttling);

/// Returns a sentence where equal work took too unequal times before the run (`noise`).
std::optional<std::string> noise_warning(const std::optional<double>& noise);

/// Returns a sentence where a CPU quota is less than that many threads can use.
std::optional<std::string> quota_warning(const std::optional<double>& quota, int threads);

/// Returns "the kernel throttled the process in 12 of 14 periods of its CPU quota"; nothing where
/// it did not.
std::optional<std::string> describe(const std::optional<Throttling>& throttling);

/// The conditions of a run that disturb all of its times.
struct Conditions {
  std::optional<double> noise;           ///< of equal work, before the run (`noise`)
  double load;                           ///< the load average before the run
  std::optional<Throttling> throttling;  ///< during the run
  /// The highest load average at the beginning of a block, less the threads of the run itself.
  std::optional<double> other_load{};
};

/// Returns the conditions that the manifest of a run states, or a `joined_manifest`.
Conditions conditions_of(const nlohmann::ordered_json& manifest);

}  // namespace beambench::measure

#pragma once
// Conditions that disturb all times of a run, and how far its times can be trusted.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/base/cpu_quota.hpp"

namespace beambench::measure {

/// Noise of equal work (`noise`) above this value shows that other work is running.
constexpr double kNoisy = 0.05;

/// Counts how much the kernel throttles a run after construction.
class ThrottlingWatch {
 public:
  /// `earlier` is the throttling of the parts before the run was resumed. `root` is as in
  /// `cpu_quota`.
  ThrottlingWatch(std::filesystem::path root, std::optional<Throttling> earlier)
      : root_(std::move(root)), earlier_(earlier) {}

  /// Returns the throttling of the whole run so far; nothing without a quota.
  std::optional<Throttling> total() const {
    return added_up(earlier_, throttling_between(begin_, read_throttling(root_)));
  }

 private:
  std::filesystem::path root_;
  std::optional<Throttling> earlier_;
  ThrottlingByGroup begin_ = read_throttling(root_);
};

/// Returns the member `throttling` of a manifest; null if there is none.
nlohmann::ordered_json to_json(const std::optional<Throttling>& throttling);

/// Returns a warning if the times of equal work before the run vary too much (`noise`).
std::optional<std::string> noise_warning(const std::optional<double>& noise);

/// Returns "other work kept 0.80 processors busy"; nothing if that is little or unknown (`kQuiet`).
std::optional<std::string> describe_other_work(const std::optional<double>& processors);

/// Returns a warning if the CPU quota is less than that many threads can use.
std::optional<std::string> quota_warning(const std::optional<double>& quota, int threads);

/// Returns "the kernel throttled the process in 12 of 14 periods of its CPU quota"; nothing if it
/// was not throttled.
std::optional<std::string> describe(const std::optional<Throttling>& throttling);

/// Conditions that disturb all times of a run.
struct Conditions {
  std::optional<double> noise;           ///< noise of equal work, before the run (`noise`)
  std::optional<double> other_work;      ///< processors that others kept busy during the run
  std::optional<Throttling> throttling;  ///< throttling during the run
};

/// Returns the conditions stated in the manifest of a run, or in a `joined_manifest`.
Conditions conditions_of(const nlohmann::ordered_json& manifest);

}  // namespace beambench::measure

#include "harness/bench/record/conditions.hpp"

#include <cstdint>

#include <fmt/format.h>

#include "harness/base/messages.hpp"
#include "harness/bench/record/cell_record.hpp"
#include "harness/bench/record/machine.hpp"

namespace beambench::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNoisy = 0.05;  // of the slowest twentieth of equal work: others are running

/// The throttling that a manifest's file states.
std::optional<Throttling> throttling_of(const Json& manifest) {
  const Json stated = manifest.at("measurement").value("throttling", Json());
  if (stated.is_null()) return std::nullopt;
  return Throttling{stated.at("periods").get<std::uint64_t>(),
                    stated.at("throttled_periods").get<std::uint64_t>(),
                    stated.at("throttled_seconds").get<double>()};
}

}  // namespace

Json to_json(const std::optional<Throttling>& throttling) {
  if (!throttling) return {};
  return {{"periods", throttling->periods},
          {"throttled_periods", throttling->throttled},
          {"throttled_seconds", throttling->seconds}};
}

std::optional<std::string> noise_warning(const std::optional<double>& noise) {
  if (!noise || *noise <= kNoisy) return std::nullopt;
  return fmt::format(
      "The machine is disturbed: one slice in twenty of equal work took at least {:.0f}% longer "
      "than usual.",
      100.0 * *noise);
}

std::optional<std::string> quota_warning(const std::optional<double>& quota, int threads) {
  if (!quota || *quota >= threads) return std::nullopt;
  return fmt::format(
      "The process has a quota of {:.3g} CPUs, less than {} can use: the kernel throttles it.",
      *quota, base::counted(static_cast<std::size_t>(threads), "thread"));
}

std::optional<std::string> describe(const std::optional<Throttling>& throttling) {
  if (!throttling || throttling->throttled == 0) return std::nullopt;
  return fmt::format("the kernel throttled the process in {} of {} periods of its CPU quota",
                     throttling->throttled, throttling->periods);
}

Conditions conditions_of(const Json& manifest) {
  const Json& noise = manifest.at("measurement").at("noise");
  return {noise.is_null() ? std::nullopt : std::optional(noise.get<double>()),
          manifest.at("machine").at("load_average").get<double>(), throttling_of(manifest)};
}

std::vector<std::string> doubts_about_times(const Conditions& conditions,
                                            std::span<const Json> cells) {
  constexpr double kMostArePrecise = 0.8;
  constexpr std::size_t kLeastForInterval = 6;
  std::size_t timed = 0, imprecise = 0, without_interval = 0;
  for (const Json& cell : cells) {
    if (cell.at("repetitions").empty()) continue;
    ++timed;
    if (cell.at("row").at("stop_reason") != to_string(StopReason::kPrecision)) ++imprecise;
    if (cell.at("repetitions").size() < kLeastForInterval) ++without_interval;
  }
  std::vector<std::string> doubts;
  if (conditions.noise && *conditions.noise > kNoisy) {
    doubts.push_back(
        fmt::format("equal work took up to {:.0f}% longer than usual", 100 * *conditions.noise));
  }
  if (conditions.load > kIdleLoad) {
    doubts.push_back(fmt::format("other work was running (load {:.2f})", conditions.load));
  }
  if (const auto throttled = describe(conditions.throttling)) doubts.push_back(*throttled);
  if (static_cast<double>(timed - imprecise) < kMostArePrecise * static_cast<double>(timed)) {
    doubts.push_back(fmt::format("{} of {} less precise than wanted", imprecise,
                                 base::counted(timed, "timed cell")));
  }
  if (without_interval > 0) {
    doubts.push_back(fmt::format("{} of {} repeated fewer than {} times, so without intervals",
                                 without_interval, base::counted(timed, "timed cell"),
                                 kLeastForInterval));
  }
  return doubts;
}

}  // namespace beambench::bench

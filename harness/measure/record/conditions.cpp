#include "harness/measure/record/conditions.hpp"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include "harness/base/messages.hpp"
#include "harness/measure/record/cell_record.hpp"
#include "harness/measure/record/other_work.hpp"

namespace beambench::measure {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the throttling stated in the JSON of a manifest.
std::optional<Throttling> throttling_of(const Json& manifest) {
  const Json stated = manifest.at("measurement").value("throttling", Json());
  if (stated.is_null()) return std::nullopt;
  return Throttling{stated.at("periods").get<std::uint64_t>(),
                    stated.at("throttled_periods").get<std::uint64_t>(),
                    stated.at("throttled_seconds").get<double>()};
}

/// Returns the processors that other work kept busy. Older records have load averages instead: one
/// before the run, and the highest at the start of a block, which includes the run's own threads.
/// They lag, so that values up to a half show no other work.
std::optional<double> other_work_of(const Json& manifest) {
  const Json& measurement = manifest.at("measurement");
  const Json& machine = manifest.at("machine");
  if (!machine.contains("load_average")) {
    const Json stated = measurement.value("other_work", Json());
    return stated.is_null() ? std::nullopt : std::optional(stated.get<double>());
  }
  auto load = machine.at("load_average").get<double>();
  if (measurement.contains("highest_load")) {
    load = std::max(
        load, measurement.at("highest_load").get<double>() - measurement.at("threads").get<int>());
  }
  return load > 0.5 ? load : 0.0;
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
      "The machine is disturbed: 5% of the slices of equal work took at least {:.0f}% longer than "
      "usual.",
      100.0 * *noise);
}

std::optional<std::string> describe_other_work(const std::optional<double>& processors) {
  if (!processors || *processors <= kQuiet) return std::nullopt;
  return fmt::format("other work kept {:.2f} processors busy", *processors);
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
          other_work_of(manifest), throttling_of(manifest)};
}

}  // namespace beambench::measure
